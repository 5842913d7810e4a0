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

#include <gtest/gtest.h>

#include "scenes/random.h"
#include "scenes/scene.h"

namespace talus::scenes {
namespace {

const Vec3& size_of(const NamedBody& body) {
    return std::get<Box>(body.definition.shape).size;
}
const Vec3& position_of(const NamedBody& body) {
    return body.definition.pose.position;
}

bool same(const Scene& a, const Scene& b) {
    return std::ranges::equal(a.bodies, b.bodies, [](const NamedBody& x, const NamedBody& y) {
        return x.name == y.name && x.definition.kind == y.definition.kind && size_of(x) == size_of(y) &&
               x.definition.pose == y.definition.pose;
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
        Vec3 p = position_of(body);
        p.x += (corner & 1 ? 0.5f : -0.5f) * size_of(body).x;
        p.y += (corner & 2 ? 0.5f : -0.5f) * size_of(body).y;
        p.z += (corner & 4 ? 0.5f : -0.5f) * size_of(body).z;
        const Vec3 from_eye = minus(p, camera.eye);
        const float depth = dot(from_eye, forward);
        if (std::abs(dot(from_eye, up)) > tangent * depth) return false;
        if (std::abs(dot(from_eye, right)) > tangent * depth * 16.0f / 9.0f) return false;
    }
    return true;
}

// Smaller versions of the large scenes, for tests that look at each pair.
const std::vector<std::string> k_standing{"stack",         "stack:height=1",        "stack:height=30",
                                          "pyramid",       "wall:width=7,height=6", "columns:side=3",
                                          "grid:stacks=7", "extreme_stack"};
const std::vector<std::string> k_falling{"pool:boxes=1", "pool", "pool:boxes=300,seed=7", "pile:boxes=700"};

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
    const std::map<std::string, std::size_t> moving{{"stack", 10},  {"pool", 1000},      {"pyramid", 210},
                                                    {"wall", 810},  {"columns", 100000}, {"grid", 20000},
                                                    {"pile", 32000}};
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
    for (const std::string& name : k_standing) {
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
