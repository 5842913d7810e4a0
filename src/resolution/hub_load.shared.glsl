// SPDX-License-Identifier: MIT
// Loads on the edges of a hub, and what share of it they get. Which hubs there are: colouring.shared.glsl.

// The load on an edge (N s) as a whole number, so that a sum of loads is the same in any order. Those of all edges of a
// hub together are at most 2^30.
inline uint part_of_load(float load, float largest, uint edge_count)
{
    if (!(largest > 1e-20f)) return 0u;
    precise float part = min(load * reciprocal(largest), 1.0f) * 1073741824.0f * reciprocal(float(edge_count));
    return uint(part);
}

// The same in the step where all edges of a hub are new: what is below it will carry it. With equal shares for the one
// step, a table on nine legs moved at 0.3 m/s a few steps later.
inline uint part_by_gravity(vec3 normal, bool hub_is_a, uint edge_count, Parameters p)
{
    float against = dot3(normal, p.gravity);
    return part_of_load(max(hub_is_a ? against : -against, 0.0f), length3(p.gravity), edge_count);
}

// Of a hub's mass, for one of `edge_count` edges that share it: half of the mass is shared alike, and half by load.
inline float share_of_hub(uint part, uint shared_load, uint edge_count)
{
    precise float alike = reciprocal(float(edge_count));
    precise float by_load = float(part) * reciprocal(float(shared_load));
    precise float share = 0.5f * (alike + by_load);
    return shared_load > 0u ? share : alike;
}
