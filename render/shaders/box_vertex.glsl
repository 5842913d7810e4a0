// SPDX-License-Identifier: MIT
// The 24 vertices of a box, four a face, made from their number.

// Of a box that reaches from -1 to 1. The painter's indices make counter-clockwise triangles of each face.
void box_vertex(uint number, out vec3 corner, out uint axis, out float side)
{
    axis = number / 8u;
    side = (number & 4u) == 0u ? -1.0 : 1.0;
    float u = (number & 1u) == 0u ? -1.0 : 1.0;
    float v = (number & 2u) == 0u ? -side : side;
    corner = axis == 0u ? vec3(side, u, v) : axis == 1u ? vec3(v, side, u) : vec3(u, v, side);
}
