// SPDX-License-Identifier: MIT
// What the solver makes of hubs (which those are: colouring.shared.glsl). Needs resolution/manifold_rows.shared.glsl.
//
// The constraints in a hub's colour are solved side by side, though they share a body. Each is given a share of its mass
// and inertia (hub_load.shared.glsl). What they do to their shares is then added up: the hub moves as their weighted mean,
// and momentum is kept (Tonge et al., "Mass Splitting for Jitter-Free Parallel Rigid Body Simulation", 2012).

inline bool is_hub_colour(uint colour) { return colour >= k_first_hub_colour && colour < k_max_colours; }

// What a constraint does to the hub itself, of the velocities that its share had before and has after a pass. The linear
// part is the hub's already, as apply_impulse takes all of its mass.
inline HubChange change_of_hub(uint body, BodyVelocity before, BodyVelocity after, float share, uint tick)
{
    precise vec3 linear = after.linear - before.linear;
    precise vec3 angular = (after.angular - before.angular) * share;
    HubChange change;
    change.linear = linear;
    change.body = body;
    change.angular = angular;
    change.tick = tick;
    return change;
}

inline HubChange no_change(uint body)
{
    HubChange none;
    none.linear = vec3(0.0f, 0.0f, 0.0f);
    none.body = body;
    none.angular = vec3(0.0f, 0.0f, 0.0f);
    none.tick = 0u;
    return none;
}

inline HubChange add_changes(HubChange a, HubChange b)
{
    precise vec3 linear = a.linear + b.linear;
    precise vec3 angular = a.angular + b.angular;
    a.linear = linear;
    a.angular = angular;
    return a;
}

inline BodyVelocity move_hub(BodyVelocity velocity, HubChange change)
{
    precise vec3 linear = velocity.linear + change.linear;
    precise vec3 angular = velocity.angular + change.angular;
    velocity.linear = linear;
    velocity.angular = angular;
    return velocity;
}
