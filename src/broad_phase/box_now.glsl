// SPDX-License-Identifier: MIT
// A body's box as the body is now, without a skin. Needs the blocks Poses, Velocities and Shapes, and
// broad_phase/aabb.shared.glsl. The CPU's counterpart is box_now.h.

OrientedBox box_now(uint body)
{
    return make_oriented_box(unpack(poses[body]), unpack(velocities[body]), unpack(shapes[body]), parameters);
}
