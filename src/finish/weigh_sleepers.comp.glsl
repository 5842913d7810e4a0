// SPDX-License-Identifier: MIT
// One invocation is a pair that the constraint graph is made of, as are all of a sleeper that something awake touches: what its contact
// does to that.
// Launched in large worlds in which bodies may sleep.
// Reads: Counters, ListedPairs, Manifolds, IslandFill; of the contacts of such a sleeper PointImpulses, ManifoldPoints,
// PointSeparations, Poses, Properties and Shapes.
// Writes: Balances.
// Needs: a barrier after store_contact_impulses.
// Overflow: none; does nothing after a step that did not fit.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "resolution/sleep.shared.glsl"
#include "resolution/colouring.shared.glsl"
#include "resolution/contact_counts.shared.glsl"
#include "resolution/contact_frame.shared.glsl"
#include "resolution/island.shared.glsl"
#include "resolution/balance.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) readonly buffer ListedPairs { uint listed_pairs[]; };
layout(std430) readonly buffer Manifolds { ManifoldCells manifolds[]; };
layout(std430) readonly buffer IslandFill { uint island_fill[]; };
layout(std430) readonly buffer Shapes { BodyShapeCells shapes[]; };
layout(std430) readonly buffer PointImpulses { NormalImpulsesCells point_impulses[]; };
layout(std430) readonly buffer ManifoldPoints { ManifoldPointCells manifold_points[]; };
layout(std430) readonly buffer PointSeparations { SeparationsCells point_separations[]; };
layout(std430) readonly buffer Poses { BodyPoseCells poses[]; };
layout(std430) readonly buffer Properties { BodyPropertiesCells properties[]; };
layout(std430) buffer Balances { uint balances[]; };

void add(uint body, uint word, float speed) { atomicAdd(balances[k_balance_words * body + word], balance_word(speed)); }

void add_push(uint body, Push push)
{
    float inverse_mass = unpack(properties[body]).inverse_mass;
    vec3 impulse = scale3(push.impulse, inverse_mass);
    vec3 moment = speeds_by_moment(push.moment, unpack(poses[body]).rotation, unpack(properties[body]), unpack(shapes[body]));
    precise float load = push.size * inverse_mass;
    for (uint i = 0u; i < 3u; ++i) {
        add(body, k_balance_impulse + i, impulse[i]);
        add(body, k_balance_moment + i, moment[i]);
    }
    add(body, k_balance_load, load);
}

bool is_weighed(uint body) { return (island_fill[body] & k_pressed) != 0u; }

void main()
{
    uint entry = item_index();
    if (entry >= counters[k_counter_graph_pairs] || (counters[k_counter_did_not_fit] & ~k_fit_reports) != 0u) return;
    uint pair = listed_pairs[entry];
    Manifold manifold = unpack(manifolds[pair]);
    if (!is_active(manifold)) return;
    bool weighs_a = is_weighed(manifold.body_a);
    bool weighs_b = is_weighed(manifold.body_b);
    if (!weighs_a && !weighs_b) return;
    vec4 normal = unpack(point_impulses[pair]).normal;
    vec3 anchors[4];
    for (uint i = 0u; i < 4u; ++i)
        anchors[i] = unpack(manifold_points[4u * pair + i]).anchor;
    if (weighs_a) add_push(manifold.body_a, push_of_contact(manifold, normal, anchors, vec3(0.0), -1.0));
    if (!weighs_b) return;
    vec3 offset = offset_at_meeting(unpack(poses[manifold.body_a]).position, unpack(poses[manifold.body_b]).position,
                                    unpack(point_separations[pair]).shift);
    add_push(manifold.body_b, push_of_contact(manifold, normal, anchors, offset, 1.0));
}
