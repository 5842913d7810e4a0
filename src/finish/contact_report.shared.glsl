// SPDX-License-Identifier: MIT
// Contact events: when two bodies touch, and what the caller is told of it.

// A gap of less than this does not end a contact (m): bodies that lie side by side would come and go.
const float k_touch_slack = 0.005f;

inline bool touches_at(float separation, float normal_impulse, bool touched_before)
{
    return normal_impulse > 0.0f || separation <= (touched_before ? k_touch_slack : 0.0f);
}

inline ContactReport make_report(Manifold manifold, uint phase)
{
    ContactReport report;
    report.body_a = manifold.body_a;
    report.body_b = manifold.body_b;
    report.phase = phase;
    report.point_count = 0u;
    report.normal = manifold.normal;
    report.sensor = manifold.colour == k_inactive_colour ? 1u : 0u;
    report.x = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    report.y = report.x;
    report.z = report.x;
    report.separation = report.x;
    report.normal_impulse = report.x;
    return report;
}

// Where a point was when it was found (m, world), `centre_a` being A's centre at the start of that step.
inline vec3 point_position(vec3 centre_a, vec3 anchor)
{
    precise vec3 position = centre_a + anchor;
    return position;
}

// Point i, after those before it.
inline ContactReport add_point(ContactReport report, int i, vec3 position, float separation, float normal_impulse)
{
    ContactReport longer = report;
    longer.x[i] = position.x;
    longer.y[i] = position.y;
    longer.z[i] = position.z;
    longer.separation[i] = separation;
    longer.normal_impulse[i] = normal_impulse;
    longer.point_count = report.point_count + 1u;
    return longer;
}
