// SPDX-License-Identifier: MIT
// Where an invocation of a kernel keeps the corners of its polygons: in shared memory, each in a column of its own. An
// array with an index that is known only at run time is no register; the compiler would put it into memory outside the
// chip, and NVIDIA's driver lets the fewer work groups run at a time the more of that they need (docs/performance.md).
// The CPU's counterpart is polygon.h.

const uint k_polygon_corners = 8u;
const uint k_polygon_columns = 64u; // the invocations of a work group

shared uvec4 polygon_corners[2u * k_polygon_corners * k_polygon_columns];

// Where it is, and the label of the edge that begins there.
struct Corner {
    vec3 position;
    uint label;
};

struct Polygon {
    uint first; // of the column's rows
    uint count; // corners, at most k_polygon_corners
};

Polygon empty_polygon() { return Polygon(0u, 0u); }

// An empty one that may be filled while this one is read. There is room for two.
Polygon polygon_beside(Polygon polygon) { return Polygon(k_polygon_corners - polygon.first, 0u); }

uint corner_place(Polygon polygon, uint i)
{
    return (polygon.first + i) * k_polygon_columns + gl_LocalInvocationIndex;
}

// For what treats several polygons side by side: with corner_of() i is the same for all of them.
Corner corner_at(Polygon polygon, uint i)
{
    uvec4 words = polygon_corners[corner_place(polygon, i)];
    return Corner(uintBitsToFloat(words.xyz), words.w);
}
Corner corner_of(Polygon polygon, uint i) { return corner_at(polygon, i); }

// The one behind corner i.
Corner corner_after(Polygon polygon, uint i)
{
    return corner_at(polygon, choose(i + 1u < polygon.count, i + 1u, 0u));
}

// What does not fit is left out: rounding may ask for a ninth. `is_wanted` holds here.
void add_corner(inout Polygon polygon, bool is_wanted, vec3 corner, uint label)
{
    if (polygon.count < k_polygon_corners) {
        polygon_corners[corner_place(polygon, polygon.count)] = uvec4(floatBitsToUint(corner), label);
        polygon.count += 1u;
    }
}
