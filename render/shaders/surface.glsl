// SPDX-License-Identifier: MIT
// What boxes and spheres look like: sun with shadow, light from sky and ground, a faint gloss, darker lines along edges.

layout(binding = 0) uniform sampler2DShadow shadow_map;

uniform bool tinted;             // some bodies have the colour of Tints
uniform bool wireframe;          // edges alone
uniform bool transparent_static; // static bodies let what is behind them through

// A random number from 0 to 1, the same for a body in every picture.
float noise(uint x)
{
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return float((x ^ (x >> 16)) >> 8) / 16777216.0;
}

// What a body looks like: one of k_kind_*, and a sensor like this whatever its kind.
const uint k_look_sensor = 3u;

uint look_of(BodyShape shape) { return is_sensor(shape) ? k_look_sensor : kind_of(shape); }

// Linear colours: static blue, rigid green, kinematic orange, a sensor turquoise, unless an overlay has another.
vec3 colour_of(uint slot, uint look)
{
    if (tinted && tints[slot] != 0u) return unpackUnorm4x8(tints[slot]).rgb * (0.85 + 0.30 * noise(slot));
    if (look == k_kind_static) return vec3(0.115, 0.220, 0.460);
    if (look == k_look_sensor) return vec3(0.010, 0.420, 0.460);
    float brightness = 0.85 + 0.30 * noise(slot);
    float warmth = noise(slot + 0x9e3779b9u) - 0.5;
    vec3 colour = look == k_kind_rigid ? vec3(0.165, 0.470, 0.135) : vec3(0.850, 0.290, 0.035);
    vec3 tint = vec3(1.0 + 0.30 * warmth, 1.0, 1.0 - 0.26 * warmth);
    return colour * tint * brightness;
}

// 1 on a line of the given half width, d away from its middle; thinner than a pixel it pales instead of flickering.
float line(float d, float half_width, float pixel)
{
    float w = max(half_width, 0.5 * pixel);
    return (1.0 - smoothstep(w - 0.5 * pixel, w + 0.5 * pixel, d)) * min(1.0, half_width / w);
}

// Half the width of the lines along the edges of a body that reaches `size` from its centre.
float edge_width(float size) { return min(0.035 * size, 0.03 * sizes.x); }

// What is left of a surface's colour d away from an edge.
float edge_line(float d, float size, float pixel)
{
    return wireframe ? 1.0 : 1.0 - 0.62 * line(d, edge_width(size), pixel);
}

// In a wireframe a line is never thinner than a pixel.
bool is_on_wire(float d, float size, float pixel) { return d < max(edge_width(size), 0.75 * pixel); }

// d away from an edge, as above. A sensor is seen by its edges, and through its faces.
float opacity_of(uint look, float d, float size, float pixel)
{
    if (look == k_look_sensor) return max(0.25, line(d, edge_width(size), pixel));
    return transparent_static && look == k_kind_static ? 0.3 : 1.0;
}

// Where the shadow map is looked up for a surface point: a texel or two off the surface, so that a surface does not
// shadow itself.
vec3 shadow_place(vec3 position, vec3 normal, vec3 lower, vec3 upper)
{
    float texel = max(upper.x - lower.x, upper.y - lower.y) / sizes.z;
    return in_shadow_map(position + (0.5 + 0.75 * sizes.w) * texel * normal, lower, upper);
}

// 0 in full shadow to 1 in the sun: percentage-closer filter over a square of places, each filtered by the texture unit.
float sunlight(vec3 p)
{
    vec2 border = min(p.xy, 1.0 - p.xy);
    float inside = smoothstep(0.0, 0.02, min(border.x, border.y));
    if (inside == 0.0) return 1.0;
    p.z = min(p.z, 1.0);
    int side = int(sizes.w);
    vec2 first = p.xy - 0.75 * float(side - 1) / sizes.z;
    float lit = 0.0;
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x)
            lit += textureLod(shadow_map, vec3(first + 1.5 * vec2(x, y) / sizes.z, p.z), 0.0);
    }
    return mix(1.0, lit / float(side * side), inside);
}

vec3 light_surface(vec3 colour, vec3 normal, vec3 to_eye, vec3 in_shadow)
{
    float facing = dot(normal, light_sun.xyz);
    float sun = facing > 0.0 ? facing * sunlight(in_shadow) : 0.0;
    vec3 sky = mix(vec3(0.14, 0.14, 0.16), vec3(0.35, 0.41, 0.50), 0.5 + 0.5 * normal.y);
    // A little light from the eye's side keeps faces that the sun does not reach apart.
    vec3 lit = colour * (sky + 0.10 * max(dot(normal, to_eye), 0.0) + vec3(0.98, 0.92, 0.82) * sun);
    if (sun > 0.0) lit += 0.06 * min(sun, 1.0) * pow(max(dot(normal, normalize(light_sun.xyz + to_eye)), 0.0), 40.0);
    return lit;
}

// Static bodies far from the middle of the picture fade into the background.
vec3 fade(vec3 lit, uint look, vec3 position, float picture_y)
{
    if (look != k_kind_static) return lit;
    return mix(lit, background(picture_y / viewport.y), smoothstep(0.7, 1.9, distance(position, target.xyz) / target.w));
}
