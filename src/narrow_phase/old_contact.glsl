// SPDX-License-Identifier: MIT
// What both kernels that write contacts say of a pair and of the last step's. Needs the blocks Counters, OldManifolds, Manifolds,
// ManifoldPoints and PointImpulses.

bool has_other_pairs() { return counters[k_counter_pairs_changed] != 0u; }

// Pairs that have been added come behind those of the last step.
bool was_listed(uint pair_index) { return pair_index < counters[k_counter_old_pair_count]; }

void compare_with_last(uint pair_index, Manifold manifold)
{
    if (has_other_pairs()) return;
    Manifold old = unpack(old_manifolds[pair_index]);
    if ((was_listed(pair_index) && is_active(old)) != is_active(manifold))
        counters[k_counter_graph_due] = 1u;
    else if (is_active(manifold) && manifold.point_count != old.point_count)
        atomicAdd(counters[k_counter_contact_count], manifold.point_count - old.point_count);
}

void put_impulses(uint pair_index, vec4 normal)
{
    NormalImpulses impulses;
    impulses.normal = normal;
    point_impulses[pair_index] = pack(impulses);
}

void put_point(uint pair_index, uint i, uint count, vec3 anchor, uint feature)
{
    if (i < count) manifold_points[4u * pair_index + i] = pack(make_point(anchor, feature));
}

void put_none(uint pair_index, Pair pair, float gap)
{
    manifolds[pair_index] = pack(no_manifold(pair, gap));
    put_impulses(pair_index, vec4(0.0));
}
