// SPDX-License-Identifier: MIT
// A body's world bounding box as the body is now, without a skin. Needs the blocks Poses, Velocities and Shapes, and
// broad_phase/aabb.shared.glsl. The CPU's counterpart is box_now.h.

Aabb box_now(uint body)
{
    return compute_aabb(unpack(poses[body]), unpack(velocities[body]), unpack(shapes[body]), parameters);
}
