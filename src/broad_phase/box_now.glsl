// SPDX-License-Identifier: MIT
// A body's box as the body is now. Needs the blocks Poses, Velocities and Shapes, broad_phase/aabb.shared.glsl and
// oriented_box.shared.glsl. The CPU's counterpart is box_now.h.

OrientedBox box_now(uint body)
{
    return make_oriented_box(unpack(poses[body]), unpack(velocities[body]), unpack(shapes[body]), parameters);
}

// As a search has it.
OrientedBox box_with_skin(uint body) { return with_skin(box_now(body), parameters); }
