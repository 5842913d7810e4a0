// SPDX-License-Identifier: MIT
// What the collision of two shapes gives, whatever the shapes: the geometry of a manifold.
//
// What is done with the four points is written out here and where they are used: to NVIDIA's compiler the variable of a loop is an
// index known only at run time, and what has an array with such an index is no register.

const uint k_axis_none = 0xffu; // spheres have no separating axis to remember
const float k_far_apart = 3.0e38f; // m: farther than anyone looks

struct ContactGeometry {
    vec3 normal; // unit, world, from A to B
    uint axis;   // which separating axis it is
    vec3 shift;  // m: B is this far on, as seen from A, where the bodies meet; the points are those of that moment
    float separation; // m, along the normal; known also where there are no points, but for bodies far apart
    uint count;  // points, 0 to 4
    // Points midway between the two surfaces, from A's centre in world axes (m). The midpoint serves both bodies, so
    // that a normal and a friction impulse change no angular momentum; the thesis takes the reference face.
    vec3 points[4];
    float separations[4]; // m, negative = overlap; without points the first is how far apart the bodies are at least, if that is known
    uint features[4];     // which vertex or edges made the point, stable while they stay the same
};

inline ContactGeometry no_contact()
{
    ContactGeometry g;
    g.normal = vec3(0.0f, 1.0f, 0.0f);
    g.axis = k_axis_none;
    g.shift = vec3(0.0f, 0.0f, 0.0f);
    g.separation = k_far_apart;
    g.count = 0u;
    g.points[0] = g.points[1] = g.points[2] = g.points[3] = vec3(0.0f, 0.0f, 0.0f);
    g.separations[0] = g.separations[1] = g.separations[2] = g.separations[3] = 0.0f;
    g.features[0] = g.features[1] = g.features[2] = g.features[3] = 0u;
    return g;
}

inline ContactGeometry one_contact(vec3 normal, vec3 point, float separation)
{
    ContactGeometry g = no_contact();
    g.normal = normal;
    g.count = 1u;
    g.separation = separation;
    g.points[0] = point;
    g.separations[0] = separation;
    return g;
}

inline ContactGeometry contact_within(float max_separation, vec3 normal, vec3 point, float separation)
{
    ContactGeometry g = no_contact();
    if (!(separation > max_separation)) g = one_contact(normal, point, separation);
    return g;
}

// The same contact seen from the other body, whose centre lies at `offset` from A's.
inline ContactGeometry swap_bodies(ContactGeometry g, vec3 offset)
{
    ContactGeometry r = g;
    r.normal = vec3(-g.normal.x, -g.normal.y, -g.normal.z);
    precise vec3 point_0 = g.points[0] - offset;
    precise vec3 point_1 = g.points[1] - offset;
    precise vec3 point_2 = g.points[2] - offset;
    precise vec3 point_3 = g.points[3] - offset;
    r.points[0] = point_0;
    r.points[1] = point_1;
    r.points[2] = point_2;
    r.points[3] = point_3;
    return r;
}

// All that a collision asks of a pair's last manifold: its axis, and the points that carried load.
struct Carriers {
    uint axis;
    uint features[4]; // k_none where a point did not, or was not there
};

inline Carriers no_carriers()
{
    Carriers carriers;
    carriers.axis = k_axis_none;
    carriers.features[0] = carriers.features[1] = carriers.features[2] = carriers.features[3] = k_none;
    return carriers;
}

inline bool carried_load(Carriers carriers, uint feature)
{
    return carriers.features[0] == feature || carriers.features[1] == feature || carriers.features[2] == feature ||
           carriers.features[3] == feature;
}
