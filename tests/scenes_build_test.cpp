// SPDX-License-Identifier: MIT
// The built-in scenes as they are built, before any step: what stands touches and does not overlap, what falls has
// room, the same words give the same scene, and wrong words are answered in words.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "scenes/random.h"
#include "scenes/scene.h"

namespace talus::scenes {
namespace {

/// Of the box, or of the cube around the sphere.
Vec3 size_of(const NamedBody& body) {
    if (const auto* box = std::get_if<Box>(&body.definition.shape)) return box->size;
    const float diameter = 2.0f * std::get<Sphere>(body.definition.shape).radius;
    return {diameter, diameter, diameter};
}
const Vec3& position_of(const NamedBody& body) {
    return body.definition.pose.position;
}

bool same(const Scene& a, const Scene& b) {
    return std::ranges::equal(a.bodies, b.bodies, [](const NamedBody& x, const NamedBody& y) {
        return x.name == y.name && x.definition.kind == y.definition.kind && size_of(x) == size_of(y) &&
               x.definition.pose == y.definition.pose && x.definition.velocity == y.definition.velocity &&
               x.definition.density == y.definition.density &&
               x.definition.material.friction == y.definition.material.friction;
    });
}

std::string error_of(const std::string& specification) {
    try {
        make_scene(specification);
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

/// How far two unturned boxes reach into each other along an axis; negative: the gap.
float reach(float centre_a, float size_a, float centre_b, float size_b) {
    return 0.5f * (size_a + size_b) - std::abs(centre_a - centre_b);
}

/// Every box must lie on top of something without a gap, and none may overlap another. All numbers of these scenes are
/// multiples of 1/8 m, so the comparisons are exact.
void expect_to_stand_exactly(const Scene& scene) {
    std::vector<const NamedBody*> bodies;
    for (const NamedBody& body : scene.bodies)
        bodies.push_back(&body);
    for (const NamedBody* a : bodies) {
        if (a->definition.kind == BodyKind::Static) continue;
        bool supported = false;
        for (const NamedBody* b : bodies) {
            if (a == b) continue;
            const Vec3 &pa = position_of(*a), &pb = position_of(*b), &sa = size_of(*a), &sb = size_of(*b);
            const float x = reach(pa.x, sa.x, pb.x, sb.x);
            const float y = reach(pa.y, sa.y, pb.y, sb.y);
            const float z = reach(pa.z, sa.z, pb.z, sb.z);
            EXPECT_FALSE(x > 0.0f && y > 0.0f && z > 0.0f) << a->name << " overlaps " << b->name;
            supported |= x > 0.0f && z > 0.0f && y == 0.0f && pb.y < pa.y;
        }
        EXPECT_TRUE(supported) << a->name << " hangs in the air";
    }
}

// ---- turned boxes and spheres ----

glm::dvec3 wide(Vec3 v) {
    return {v.x, v.y, v.z};
}

glm::dmat3 axes_of(const NamedBody& body) {
    const Quat& q = body.definition.pose.rotation;
    return glm::mat3_cast(glm::dquat(q.w, q.x, q.y, q.z));
}

bool is_sphere(const NamedBody& body) {
    return std::holds_alternative<Sphere>(body.definition.shape);
}

/// How far apart two boxes are along the axis that separates them most (m): 0 where they touch, negative where they
/// overlap.
double gap_of_boxes(const NamedBody& a, const NamedBody& b) {
    const glm::dmat3 axes_a = axes_of(a), axes_b = axes_of(b);
    const glm::dvec3 half_a = 0.5 * wide(size_of(a)), half_b = 0.5 * wide(size_of(b));
    const glm::dvec3 apart = wide(position_of(b)) - wide(position_of(a));
    double largest = -1e9;
    const auto try_axis = [&](const glm::dvec3& axis) {
        const double length = glm::length(axis);
        if (length < 1e-3) return; // of two parallel edges
        double gap = std::abs(glm::dot(apart, axis));
        for (int i = 0; i < 3; ++i)
            gap -= half_a[i] * std::abs(glm::dot(axes_a[i], axis)) + half_b[i] * std::abs(glm::dot(axes_b[i], axis));
        largest = std::max(largest, gap / length);
    };
    for (int i = 0; i < 3; ++i) {
        try_axis(axes_a[i]);
        try_axis(axes_b[i]);
        for (int j = 0; j < 3; ++j)
            try_axis(glm::cross(axes_a[i], axes_b[j]));
    }
    return largest;
}

/// Of a sphere outside a box, or of two spheres.
double gap_of_sphere(const NamedBody& sphere, const NamedBody& other) {
    const double radius = 0.5 * size_of(sphere).x;
    const glm::dvec3 apart = wide(position_of(sphere)) - wide(position_of(other));
    if (is_sphere(other)) return glm::length(apart) - radius - 0.5 * size_of(other).x;
    const glm::dvec3 half = 0.5 * wide(size_of(other));
    const glm::dvec3 local = glm::transpose(axes_of(other)) * apart;
    return glm::length(local - glm::clamp(local, -half, half)) - radius;
}

double gap(const NamedBody& a, const NamedBody& b) {
    if (is_sphere(a)) return gap_of_sphere(a, b);
    if (is_sphere(b)) return gap_of_sphere(b, a);
    return gap_of_boxes(a, b);
}

/// Positions of floats 20 to 40 m from the origin are multiples of 2 to 4 µm; rotations round at 6e-8.
constexpr double k_rounding = 5e-6;

/// As expect_to_stand_exactly, to the rounding of turned bodies.
void expect_to_stand_turned(const Scene& scene) {
    for (const NamedBody& a : scene.bodies) {
        if (a.definition.kind == BodyKind::Static) continue;
        bool supported = false;
        for (const NamedBody& b : scene.bodies) {
            if (&a == &b) continue;
            const double reaches = 0.5 * (glm::length(wide(size_of(a))) + glm::length(wide(size_of(b))));
            if (glm::distance(wide(position_of(a)), wide(position_of(b))) > reaches) continue;
            const double distance = gap(a, b);
            EXPECT_GT(distance, -k_rounding) << a.name << " overlaps " << b.name;
            supported |= distance < k_rounding && position_of(b).y < position_of(a).y;
        }
        EXPECT_TRUE(supported) << a.name << " hangs in the air";
    }
}

/// Whether the whole box lies in a picture of 16:9.
bool is_seen(const Camera& camera, const NamedBody& body) {
    const auto minus = [](Vec3 a, Vec3 b) { return Vec3{a.x - b.x, a.y - b.y, a.z - b.z}; };
    const auto dot = [](Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; };
    const auto cross = [](Vec3 a, Vec3 b) {
        return Vec3{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    };
    const auto unit = [&](Vec3 a) {
        const float length = std::sqrt(dot(a, a));
        return Vec3{a.x / length, a.y / length, a.z / length};
    };
    const Vec3 forward = unit(minus(camera.target, camera.eye));
    const Vec3 right = unit(cross(forward, {0.0f, 1.0f, 0.0f}));
    const Vec3 up = cross(right, forward);
    const float tangent = std::tan(0.5f * camera.vertical_fov);
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 side{corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5};
        const glm::dvec3 p = wide(position_of(body)) + axes_of(body) * (side * wide(size_of(body)));
        const Vec3 from_eye =
            minus({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)}, camera.eye);
        const float depth = dot(from_eye, forward);
        if (std::abs(dot(from_eye, up)) > tangent * depth) return false;
        if (std::abs(dot(from_eye, right)) > tangent * depth * 16.0f / 9.0f) return false;
    }
    return true;
}

// Smaller versions of the large scenes, for tests that look at each pair.
const std::vector<std::string> k_standing{"stack",          "stack:height=1",        "stack:height=30",
                                          "pyramid",        "wall:width=7,height=6", "columns:side=3",
                                          "grid:stacks=7",  "extreme_stack",         "many_pyramids:side=3",
                                          "plate:boxes=23", "heavy_on_light",        "worlds:count=5,boxes=21"};
// Scenes whose bodies are turned, or lie at other places than multiples of 1/8 m.
const std::vector<std::string> k_standing_turned{"card_house",
                                                 "card_house:levels=1",
                                                 "card_house:levels=9",
                                                 "dominoes",
                                                 "dominoes:bend=0",
                                                 "dominoes:bend=60,count=300",
                                                 "slope",
                                                 "slope:angle=0",
                                                 "slope:angle=60,boxes=35",
                                                 "brick_ring:courses=9,radius=20",
                                                 "brick_gables:across=1,rows=2,base=6",
                                                 "brick_gables:across=3,rows=3,base=30"};
const std::vector<std::string> k_falling{"pool:boxes=1",    "pool",           "pool:boxes=300,seed=7",
                                         "pile:boxes=700",  "rubble:boxes=1", "rubble:boxes=4,ratio=1000",
                                         "rubble:boxes=900"};

TEST(scenes, every_listed_scene_builds_and_can_be_given_again_by_its_name) {
    for (const SceneInfo& info : list_scenes()) {
        const Scene scene = make_scene(info.name);
        EXPECT_TRUE(scene.name.starts_with(info.name)) << scene.name;
        EXPECT_FALSE(info.summary.empty());
        EXPECT_TRUE(same(scene, make_scene(scene.name))) << scene.name;
        for (const Parameter& parameter : info.parameters) {
            EXPECT_NE(scene.name.find(parameter.name + "="), std::string::npos) << scene.name;
            EXPECT_LE(parameter.minimum, parameter.default_value);
            EXPECT_LE(parameter.default_value, parameter.maximum);
        }
    }
}

TEST(scenes, the_defaults_are_those_of_the_documentation) {
    const std::map<std::string, std::size_t> moving{{"stack", 10},
                                                    {"pool", 1000},
                                                    {"pyramid", 210},
                                                    {"wall", 810},
                                                    {"columns", 100000},
                                                    {"grid", 20000},
                                                    {"pile", 32000},
                                                    {"rubble", 32000},
                                                    {"card_house", 40},
                                                    {"dominoes", 100},
                                                    {"slope", 10},
                                                    {"plate", 4001},
                                                    {"heavy_on_light", 8},
                                                    {"many_pyramids", 10780},
                                                    {"worlds", 4096},
                                                    // The bricks of the published scenes, and the spheres.
                                                    {"brick_ring", 110332 + 1},
                                                    {"brick_gables", 505920 + 2}};
    for (const auto& [name, count] : moving) {
        const Scene scene = make_scene(name);
        EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(
                      scene.bodies, BodyKind::Rigid, [](const NamedBody& body) { return body.definition.kind; })),
                  count)
            << name;
    }
    EXPECT_EQ(make_scene("stack").name, "stack:height=10");
    EXPECT_EQ(make_scene("pool:seed=3").name, "pool:boxes=1000,seed=3");
    EXPECT_EQ(make_scene("pool:boxes=1000000").name, "pool:boxes=1000000,seed=1");
    const std::size_t extreme = make_scene("extreme_stack").bodies.size();
    EXPECT_GE(extreme, 500u);
    EXPECT_LE(extreme, 700u);
}

TEST(scenes, what_stands_touches_exactly_and_overlaps_nowhere) {
    for (const std::string& name : k_standing) {
        SCOPED_TRACE(name);
        expect_to_stand_exactly(make_scene(name));
    }
    for (const std::string& name : k_standing_turned) {
        SCOPED_TRACE(name);
        expect_to_stand_turned(make_scene(name));
    }
}

TEST(scenes, leaning_cards_touch_their_partner_and_the_card_or_floor_below) {
    const Scene scene = make_scene("card_house:levels=4");
    const auto leans = [](const NamedBody& body) { return body.definition.pose.rotation.z != 0.0f; };
    for (const NamedBody& a : scene.bodies) {
        if (a.definition.kind == BodyKind::Static || !leans(a)) continue;
        int partners = 0, below = 0, above = 0;
        for (const NamedBody& b : scene.bodies) {
            if (&a == &b || gap(a, b) > k_rounding) continue;
            const float height = position_of(b).y - position_of(a).y;
            (leans(b) ? partners : height < 0.0f ? below : above) += 1;
        }
        EXPECT_EQ(partners, 1) << a.name;
        EXPECT_EQ(below, 1) << a.name;
        EXPECT_LE(above, 1) << a.name;
    }
}

TEST(scenes, a_rolling_sphere_does_not_slip) {
    for (const char* name : {"brick_ring:courses=1,radius=20", "brick_gables:across=2,rows=1,base=1"}) {
        for (const NamedBody& body : make_scene(name).bodies) {
            if (!is_sphere(body)) continue;
            // The velocity of the point on the ground: v + w × (0, -r, 0).
            const auto& [linear, angular] = body.definition.velocity;
            const float radius = position_of(body).y;
            EXPECT_EQ(std::hypot(linear.x, linear.y, linear.z), 25.0f) << name;
            EXPECT_NEAR(linear.x + angular.z * radius, 0.0f, 1e-5f) << name;
            EXPECT_NEAR(linear.z - angular.x * radius, 0.0f, 1e-5f) << name;
        }
    }
}

TEST(scenes, what_is_heavy_lies_on_what_is_light) {
    std::vector<float> ratios;
    const Scene scene = make_scene("heavy_on_light:ratio=2500.5");
    EXPECT_EQ(scene.name, "heavy_on_light:ratio=2500.5");
    for (std::size_t i = 1; i + 1 < scene.bodies.size(); i += 2) {
        const NamedBody &light = scene.bodies[i], &heavy = scene.bodies[i + 1];
        EXPECT_EQ(position_of(heavy).y - position_of(light).y, 1.0f);
        ratios.push_back(heavy.definition.density / light.definition.density);
    }
    EXPECT_EQ(ratios, (std::vector<float>{1.0f, 10.0f, 100.0f, 1000.0f, 2500.5f}));
}

TEST(scenes, the_million_is_the_pile) {
    EXPECT_TRUE(same(make_scene("million:boxes=300,seed=8"), make_scene("pile:boxes=300,seed=8")));
}

TEST(scenes, rubble_has_boxes_of_every_size_and_most_of_them_small) {
    std::map<float, std::size_t> count_of;
    for (const NamedBody& body : make_scene("rubble:boxes=2000,ratio=33").bodies)
        if (body.definition.kind == BodyKind::Rigid) ++count_of[size_of(body).x];
    std::vector<float> edges;
    std::size_t larger = 2000;
    for (const auto& [edge, count] : count_of) {
        edges.push_back(edge);
        EXPECT_LT(count, larger) << edge;
        larger = count;
    }
    EXPECT_EQ(edges, (std::vector<float>{0.125f, 0.25f, 0.5f, 1.0f, 2.0f, 4.0f}));
    EXPECT_GT(count_of[0.125f], 1400u);
}

TEST(scenes, what_falls_starts_apart_and_between_the_walls) {
    for (const std::string& name : k_falling) {
        SCOPED_TRACE(name);
        const Scene scene = make_scene(name);
        const float inner = position_of(scene.bodies.at(2)).x - 0.5f * size_of(scene.bodies.at(2)).x;
        ASSERT_EQ(scene.bodies.at(2).name, "right wall");
        const auto radius = [](const NamedBody& body) {
            const Vec3& s = size_of(body);
            return 0.5f * std::sqrt(s.x * s.x + s.y * s.y + s.z * s.z);
        };
        for (std::size_t i = 5; i < scene.bodies.size(); ++i) {
            const NamedBody& a = scene.bodies[i];
            const Vec3& p = position_of(a);
            EXPECT_GE(p.y, radius(a)) << a.name;
            EXPECT_LE(std::max(std::abs(p.x), std::abs(p.z)) + radius(a), inner) << a.name;
            const Quat& q = a.definition.pose.rotation;
            EXPECT_NEAR(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w, 1.0f, 1e-6f) << a.name;
            for (std::size_t j = 5; j < i; ++j) {
                const Vec3& other = position_of(scene.bodies[j]);
                const float apart = std::hypot(p.x - other.x, p.y - other.y, p.z - other.z);
                EXPECT_GT(apart, radius(a) + radius(scene.bodies[j])) << a.name << ", " << scene.bodies[j].name;
            }
        }
    }
}

TEST(scenes, bodies_have_their_own_names_and_lie_within_the_bounds) {
    std::vector<std::string> all = k_standing;
    all.insert(all.end(), k_standing_turned.begin(), k_standing_turned.end());
    all.insert(all.end(), k_falling.begin(), k_falling.end());
    for (const std::string& name : all) {
        SCOPED_TRACE(name);
        const Scene scene = make_scene(name);
        std::set<std::string> names;
        EXPECT_EQ(scene.bodies.at(0).name, "ground");
        EXPECT_EQ(scene.bodies.back().name.substr(0, 4), "box ");
        for (const NamedBody& body : scene.bodies) {
            EXPECT_TRUE(names.insert(body.name).second) << body.name;
            if (body.definition.kind == BodyKind::Static) continue;
            const Vec3& p = position_of(body);
            EXPECT_TRUE(p.x > scene.bounds.lower.x && p.y > scene.bounds.lower.y && p.z > scene.bounds.lower.z &&
                        p.x < scene.bounds.upper.x && p.y < scene.bounds.upper.y && p.z < scene.bounds.upper.z)
                << body.name;
        }
    }
}

TEST(scenes, the_camera_sees_all_that_stands) {
    std::vector<std::string> all = k_standing;
    all.insert(all.end(), k_standing_turned.begin(), k_standing_turned.end());
    for (const std::string& name : all) {
        const Scene scene = make_scene(name);
        for (const NamedBody& body : scene.bodies)
            if (body.definition.kind != BodyKind::Static) {
                EXPECT_TRUE(is_seen(scene.camera, body)) << name << ", " << body.name;
            }
    }
}

TEST(scenes, a_seed_gives_the_same_scene_with_every_compiler) {
    EXPECT_TRUE(same(make_scene("pool:boxes=50,seed=4"), make_scene("pool:seed=4,boxes=50")));
    EXPECT_FALSE(same(make_scene("pool:boxes=50,seed=4"), make_scene("pool:boxes=50,seed=5")));

    // The published first outputs of SplitMix64 for this seed.
    Random random(1234567);
    EXPECT_EQ(random.next(), 6457827717110365317u);
    EXPECT_EQ(random.next(), 3203168211198807973u);
    EXPECT_EQ(random.next(), 9817491932198370423u);

    const Pose pose = make_scene("pile:boxes=20,seed=42").bodies.back().definition.pose;
    EXPECT_EQ(pose.position, (Vec3{0x1.59e774p+2f, 0x1.6552cp+0f, 0x1.5a2ad8p+1f}));
    EXPECT_EQ(pose.rotation, (Quat{-0x1.53daecp-1f, 0x1.20fba4p-1f, -0x1.0f93f6p-3f, 0x1.e3d33p-2f}));
}

TEST(scenes, random_rotations_are_spread_evenly) {
    // For a uniform rotation each component of the quaternion has the mean 0 and the mean square 1/4.
    constexpr int k_count = 20000;
    Random random(9);
    double sum[4] = {}, squares[4] = {};
    for (int i = 0; i < k_count; ++i) {
        const Quat q = random.rotation();
        const float components[] = {q.x, q.y, q.z, q.w};
        for (int c = 0; c < 4; ++c) {
            sum[c] += components[c];
            squares[c] += static_cast<double>(components[c]) * components[c];
        }
    }
    for (int c = 0; c < 4; ++c) {
        EXPECT_NEAR(sum[c] / k_count, 0.0, 0.02);
        EXPECT_NEAR(squares[c] / k_count, 0.25, 0.01);
    }
}

TEST(scenes, wrong_words_are_answered_in_words) {
    const std::vector<std::pair<std::string, std::string>> cases{
        {"stak", "unknown scene 'stak'; did you mean 'stack'? The scenes are: stack, pool, extreme_stack"},
        {"", "unknown scene ''. The scenes are: stack"},
        {"elephant", "unknown scene 'elephant'. The scenes are: stack"},
        {"stack:hight=3", "scene 'stack' has no parameter 'hight'; did you mean 'height'?"},
        {"wall:colour=3", "Its parameters are: width (boxes in a row, a whole number from 1 to 1000), height"},
        {"extreme_stack:size=3", "no parameter 'size'. Its parameters are: height (boxes in the tallest stack"},
        {"stack:height=3,height=4", "height is given twice"},
        {"stack:height=2.5", "must be a whole number from 1 to 1000, not '2.5'"},
        {"stack:height=ten", "must be a whole number from 1 to 1000, not 'ten'"},
        {"stack:height=3m", "must be a whole number from 1 to 1000, not '3m'"},
        {"slope:angle=61", "angle (of the plate, in degrees) must be a number from 0 to 60, not '61'"},
        {"slope:friction=-0.1", "must be a number from 0 to 10, not '-0.1'"},
        {"slope:friction=inf", "must be a number from 0 to 10, not 'inf'"},
        {"heavy_on_light:ratio=0.5", "must be a number from 1 to 1000000, not '0.5'"},
        {"brick_rings", "unknown scene 'brick_rings'; did you mean 'brick_ring'?"},
        {"stack:height=nan", "must be a whole number from 1 to 1000, not 'nan'"},
        {"stack:height=0", "must be a whole number from 1 to 1000, not '0'"},
        {"stack:height=-4", "must be a whole number from 1 to 1000, not '-4'"},
        {"pool:boxes=1000001", "must be a whole number from 1 to 1000000, not '1000001'"},
        {"stack:height=", "must be a whole number from 1 to 1000, not ''"},
        {"stack:height", "'height' is not of the form name=value"},
        {"stack:=3", "'=3' is not of the form name=value"},
        {"stack:height=3,", "'' is not of the form name=value"},
        {"model.obj", "its name must end in .gltf or .glb, not in .obj"},
        {"no_such_file.gltf", "cannot read 'no_such_file.gltf': there is no such file"},
    };
    for (const auto& [specification, expected] : cases)
        EXPECT_NE(error_of(specification).find(expected), std::string::npos)
            << specification << ": " << error_of(specification);
}

} // namespace
} // namespace talus::scenes
