// SPDX-License-Identifier: MIT
// Fits the shadow map to the bodies in sight, without a read-back.
// One invocation is an entry of Slots.
// Reads Poses, Shapes, Slots; writes ShadowBounds, which the host has emptied.
// Sensors throw no shadow. Large static bodies (grounds) do not count: they receive shadows, and would make the map
// coarse.

layout(local_size_x = 64) in;

uniform uint body_count;

bool in_sight(vec3 centre, float reach)
{
    // Bodies beside the picture may throw their shadow into it.
    reach += 0.1 * target.w;
    if (distance(centre, target.xyz) > 8.0 * target.w) return false;
    mat4 rows = transpose(view_projection);
    vec4 planes[4] = vec4[4](rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1], rows[3] - rows[1]);
    for (int i = 0; i < 4; ++i) {
        if (dot(planes[i], vec4(centre, 1.0)) < -reach * length(planes[i].xyz)) return false;
    }
    return true;
}

void main()
{
    uint entry = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + gl_LocalInvocationID.x;
    if (entry >= body_count) return;
    uint slot = slots[entry];
    BodyShape shape = shapes[slot];
    if (is_sensor(shape)) return;
    vec3 centre = poses[slot].position;
    float reach = reach_of(shape);
    if (kind_of(shape) == k_kind_static && reach > 0.75 * target.w) return;
    if (!in_sight(centre, reach)) return;

    vec3 p = in_light_axes(centre);
    for (int i = 0; i < 3; ++i) {
        atomicMin(lower_keys[i], key_of(p[i] - reach));
        atomicMax(upper_keys[i], key_of(p[i] + reach));
    }
}
