// SPDX-License-Identifier: MIT
// The glTF importer: what it reads, what it refuses and in which words, and that no broken file gets past it. The files
// are written here, into the temporary folder.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "scenes/scene.h"

namespace talus::scenes {
namespace {

/// A file that is gone after the test.
class TemporaryFile {
public:
    TemporaryFile(const std::string& ending, const std::string& content)
        : path(std::filesystem::temp_directory_path() /
               ("talus_gltf_test_" + std::to_string(getpid()) + "_" + std::to_string(++count) + ending)) {
        std::ofstream(path, std::ios::binary) << content;
    }
    ~TemporaryFile() { std::filesystem::remove(path); }
    std::string name() const { return path.string(); }

private:
    static inline int count = 0;
    std::filesystem::path path;
};

Scene read(const std::string& content, const std::string& ending = ".gltf") {
    return make_scene(TemporaryFile(ending, content).name());
}

std::string error_of(const std::string& content, const std::string& ending = ".gltf") {
    try {
        read(content, ending);
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

const std::string k_shapes = R"([{"type":"box","box":{"size":[1,2,3]}},{"type":"sphere","sphere":{"radius":0.5}},
    {"type":"capsule","capsule":{"height":1}},{"type":"box"},{"type":"box","box":{"size":[1,-2,3]}},
    {"type":"sphere","sphere":{"radius":0}}])";
const std::string k_materials = R"([{"staticFriction":0.3,"dynamicFriction":0.3,"restitution":0.25},
    {"staticFriction":0.9,"dynamicFriction":0.2,"frictionCombine":"minimum","restitutionCombine":"multiply"},{},
    {"frictionCombine":"mean"},{"dynamicFriction":-1},{"restitution":2}])";
const std::string k_filters = R"([{"collisionSystems":["a"],"collideWithSystems":["a"]},
    {"collisionSystems":["b"],"collideWithSystems":["b"]},{"collisionSystems":["c"],"notCollideWithSystems":["c"]},
    {"collisionSystems":["d"],"notCollideWithSystems":["e"]}])";

/// A document around these nodes; `rest` is put into it as it is.
std::string document(const std::string& nodes, const std::string& rest = "") {
    return R"({"asset":{"version":"2.0"},"extensions":{"KHR_implicit_shapes":{"shapes":)" + k_shapes +
           R"(},"KHR_physics_rigid_bodies":{"physicsMaterials":)" + k_materials + R"(,"collisionFilters":)" +
           k_filters + R"(}},"nodes":[)" + nodes + "]" + rest + "}";
}

/// `"extensions":{...}` of a node.
std::string physics(const std::string& members) {
    return R"("extensions":{"KHR_physics_rigid_bodies":{)" + members + "}}";
}

std::string collider(const std::string& shape = "0") {
    return R"("collider":{"geometry":{"shape":)" + shape + "}}";
}

/// The only body of a file with this one node.
BodyDefinition body_of(const std::string& node) {
    const Scene scene = read(document("{" + node + "}"));
    EXPECT_EQ(scene.bodies.size(), 1u);
    return scene.bodies.at(0).definition;
}

void expect_near(const Vec3& actual, const Vec3& expected, float tolerance = 1e-5f) {
    EXPECT_NEAR(actual.x, expected.x, tolerance);
    EXPECT_NEAR(actual.y, expected.y, tolerance);
    EXPECT_NEAR(actual.z, expected.z, tolerance);
}

const std::string k_quarter_turn_z = R"("rotation":[0,0,0.70710678,0.70710678])";

TEST(gltf, static_and_moving_boxes_and_spheres) {
    const Scene scene = read(document(
        R"({"name":"floor",)" + physics(collider()) + R"(},{"name":"ball","translation":[1,2,3],)" +
        physics(R"("motion":{"mass":4},)" + collider("1")) + R"(},{"name":"lift",)" +
        physics(R"("motion":{"isKinematic":true,"mass":4,"gravityFactor":2,"linearVelocity":[0,1,0]},)" + collider()) +
        "}"));
    ASSERT_EQ(scene.bodies.size(), 3u);
    EXPECT_TRUE(scene.warnings.empty());
    EXPECT_EQ(scene.settings.gravity, (Vec3{0.0f, -9.81f, 0.0f}));

    EXPECT_EQ(scene.bodies[0].name, "floor");
    EXPECT_EQ(scene.bodies[0].definition.kind, BodyKind::Static);
    EXPECT_EQ(std::get<Box>(scene.bodies[0].definition.shape).size, (Vec3{1.0f, 2.0f, 3.0f}));

    const BodyDefinition& ball = scene.bodies[1].definition;
    EXPECT_EQ(ball.kind, BodyKind::Rigid);
    EXPECT_EQ(std::get<Sphere>(ball.shape).radius, 0.5f);
    EXPECT_EQ(ball.mass, 4.0f);
    EXPECT_EQ(ball.gravity_scale, 1.0f);
    EXPECT_EQ(ball.pose, (Pose{{1.0f, 2.0f, 3.0f}, {}}));

    const BodyDefinition& lift = scene.bodies[2].definition;
    EXPECT_EQ(lift.kind, BodyKind::Kinematic);
    EXPECT_FALSE(lift.mass);
    EXPECT_EQ(lift.gravity_scale.value_or(0.0f), 0.0f) << "a kinematic body's velocity is constant";
    EXPECT_EQ(lift.velocity.linear, (Vec3{0.0f, 1.0f, 0.0f}));
}

TEST(gltf, defaults_of_the_extensions) {
    const BodyDefinition body =
        body_of(physics(R"("motion":{},"collider":{"geometry":{"shape":3},"physicsMaterial":2})"));
    EXPECT_EQ(std::get<Box>(body.shape).size, (Vec3{1.0f, 1.0f, 1.0f}));
    EXPECT_FALSE(body.mass) << "from the density";
    EXPECT_FALSE(body.inertia);
    EXPECT_EQ(body.material.friction, 0.6f);
    EXPECT_EQ(body.material.restitution, 0.0f);
    EXPECT_EQ(body.material.friction_combine, Combine::Average);
    EXPECT_EQ(body.material.restitution_combine, Combine::Average);
}

TEST(gltf, materials_and_a_warning_where_the_two_frictions_differ) {
    const Scene scene = read(
        document(R"({"name":"slide",)" + physics(R"("collider":{"geometry":{"shape":0},"physicsMaterial":1})") + "}"));
    const Material& material = scene.bodies.at(0).definition.material;
    EXPECT_EQ(material.friction, 0.2f);
    EXPECT_EQ(material.friction_combine, Combine::Minimum);
    EXPECT_EQ(material.restitution_combine, Combine::Multiply);
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_EQ(scene.warnings[0], "1 collider (slide) with a static friction that differs from the dynamic one: the "
                                 "dynamic one is used for both");
}

TEST(gltf, an_infinite_mass_is_a_kinematic_body_that_gravity_moves) {
    const BodyDefinition falls = body_of(physics(R"("motion":{"mass":0},)" + collider()));
    EXPECT_EQ(falls.kind, BodyKind::Kinematic);
    EXPECT_EQ(falls.gravity_scale, 1.0f);
    const BodyDefinition hangs = body_of(physics(R"("motion":{"mass":0,"gravityFactor":0},)" + collider()));
    EXPECT_EQ(hangs.gravity_scale, 0.0f);
}

TEST(gltf, poses_go_through_the_node_tree) {
    // The parent turns x to y and doubles; the child is one metre along its x.
    const std::string child = R"({"name":"child","translation":[1,0,0],)" + physics(collider()) + "}";
    const std::string parent = R"({"children":[1],"translation":[10,0,0],"scale":[2,2,2],)" + k_quarter_turn_z + "},";
    const std::string matrix = R"({"children":[1],"matrix":[0,2,0,0,-2,0,0,0,0,0,2,0,10,0,0,1]},)";
    for (const std::string& node : {parent, matrix}) {
        const Scene scene = read(document(node + child));
        ASSERT_EQ(scene.bodies.size(), 1u);
        const BodyDefinition& body = scene.bodies[0].definition;
        EXPECT_EQ(scene.bodies[0].name, "child");
        expect_near(body.pose.position, {10.0f, 2.0f, 0.0f});
        EXPECT_NEAR(std::abs(body.pose.rotation.z), 0.70710678f, 1e-6f);
        expect_near(std::get<Box>(body.shape).size, {2.0f, 4.0f, 6.0f});
    }
}

TEST(gltf, scale_is_baked_by_its_absolute_value) {
    const BodyDefinition box = body_of(R"("scale":[1,-2,3],)" + physics(collider()));
    expect_near(std::get<Box>(box.shape).size, {1.0f, 4.0f, 9.0f});
    const Quat& q = box.pose.rotation;
    EXPECT_NEAR(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w, 1.0f, 1e-6f);
    const BodyDefinition sphere = body_of(R"("scale":[-3,3,3],)" + physics(collider("1")));
    EXPECT_NEAR(std::get<Sphere>(sphere.shape).radius, 1.5f, 1e-6f);
}

TEST(gltf, velocities_turn_with_the_node_and_are_not_scaled) {
    const BodyDefinition body =
        body_of(k_quarter_turn_z + R"(,"scale":[5,5,5],)" +
                physics(R"("motion":{"linearVelocity":[1,0,0],"angularVelocity":[0,2,0]},)" + collider()));
    expect_near(body.velocity.linear, {0.0f, 1.0f, 0.0f});
    expect_near(body.velocity.angular, {-2.0f, 0.0f, 0.0f});
}

TEST(gltf, a_single_collider_below_its_motion_is_the_body) {
    const std::string below =
        R"(,{"name":"hull","translation":[0,3,0],)" + k_quarter_turn_z + "," + physics(collider()) + "}";
    const Scene scene = read(document(R"({"name":"ship","children":[1],)" +
                                      physics(R"("motion":{"mass":2,"inertiaDiagonal":[1,2,3]})") + "}" + below));
    ASSERT_EQ(scene.bodies.size(), 1u);
    EXPECT_EQ(scene.bodies[0].name, "ship");
    const BodyDefinition& body = scene.bodies[0].definition;
    expect_near(body.pose.position, {0.0f, 3.0f, 0.0f});
    // The body's axes are the collider's: its x is the node's y.
    expect_near(body.inertia.value_or(Vec3{}), {2.0f, 1.0f, 3.0f});

    const std::string with_own_motion = R"(,{"name":"dinghy",)" + physics(R"("motion":{},)" + collider()) + "}";
    EXPECT_EQ(read(document(R"({"children":[1],)" + physics(R"("motion":{},)" + collider("1")) + "}" + with_own_motion))
                  .bodies.size(),
              2u);
}

TEST(gltf, a_centre_of_mass_is_taken_where_it_is_the_middle_of_the_shape) {
    const std::string below = R"(,{"translation":[0,3,0],)" + physics(collider()) + "}";
    const auto with_centre = [&](const std::string& centre) {
        return document(R"({"name":"ship","children":[1],)" + physics(R"("motion":{"centerOfMass":)" + centre + "}") +
                        "}" + below);
    };
    EXPECT_EQ(read(with_centre("[0,3,0]")).bodies.size(), 1u);
    EXPECT_NE(error_of(with_centre("[0,2,0]")).find("node 0 'ship': its centre of mass (centerOfMass) is 1.000000 m"),
              std::string::npos);
}

TEST(gltf, inertia_may_be_given_about_exchanged_axes) {
    const std::string turned = R"("motion":{"mass":1,"inertiaDiagonal":[1,2,3],"inertiaOrientation":)";
    const BodyDefinition body = body_of(physics(turned + "[0,0,0.70710678,0.70710678]}," + collider()));
    expect_near(body.inertia.value_or(Vec3{}), {2.0f, 1.0f, 3.0f});
    EXPECT_NE(error_of(document("{" + physics(turned + "[0,0,0.38268343,0.92387953]}," + collider()) + "}"))
                  .find("principal axes"),
              std::string::npos);
}

TEST(gltf, shapes_may_stand_in_the_document_itself) {
    const Scene scene =
        read(R"({"asset":{"version":"2.1"},"shapes":)" + k_shapes + R"(,"nodes":[{)" + physics(collider()) + "}]}");
    EXPECT_EQ(std::get<Box>(scene.bodies.at(0).definition.shape).size, (Vec3{1.0f, 2.0f, 3.0f}));
}

TEST(gltf, names_become_unique) {
    const auto named = [](const std::string& name) {
        return R"({"name":")" + name + "\"," + physics(collider()) + "}";
    };
    const Scene scene = read(
        document(named("Cube") + "," + named("Cube") + "," + named("Cube (2)") + ",{" + physics(collider()) + "}"));
    std::vector<std::string> names;
    for (const NamedBody& body : scene.bodies)
        names.push_back(body.name);
    EXPECT_EQ(names, (std::vector<std::string>{"Cube", "Cube (2)", "Cube (2) (2)", "node 3"}));
}

TEST(gltf, only_the_shown_scene_is_read) {
    const std::string two = "{" + physics(collider()) + R"(},{"name":"shown",)" + physics(collider()) + "}";
    const Scene scene = read(document(two, R"(,"scene":1,"scenes":[{"nodes":[0]},{"nodes":[1]}])"));
    ASSERT_EQ(scene.bodies.size(), 1u);
    EXPECT_EQ(scene.bodies[0].name, "shown");
}

TEST(gltf, what_is_only_to_be_seen_is_passed_over) {
    const Scene scene = read(document(
        R"({"mesh":0,"camera":7,"skin":3,)" + physics(collider()) + "}",
        R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"buffers":[{"uri":"gone.bin","byteLength":9}],)"
        R"("images":[{"uri":"gone.png"}],"extensionsRequired":["KHR_lights_punctual"])"));
    EXPECT_EQ(scene.bodies.size(), 1u);
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(gltf, triggers_become_sensors) {
    const std::string trigger = R"("trigger":{"geometry":{"shape":1}})";
    const Scene scene =
        read(document(R"({"name":"zone","translation":[0,2,0],"scale":[3,3,3],)" + physics(trigger) +
                      R"(},{"name":"both",)" + physics(collider() + "," + trigger) + R"(},{"name":"probe",)" +
                      physics(R"("motion":{"isKinematic":true,"linearVelocity":[1,0,0]},)" + trigger) +
                      R"(},{"name":"compound","children":[4,5],)" + physics(R"("trigger":{"nodes":[4,5]})") +
                      R"(},{"name":"part 1",)" + physics(trigger) + R"(},{"name":"part 2",)" + physics(trigger) + "}"));
    ASSERT_EQ(scene.bodies.size(), 6u);
    const BodyDefinition& zone = scene.bodies[0].definition;
    EXPECT_TRUE(zone.sensor);
    EXPECT_EQ(zone.kind, BodyKind::Static);
    EXPECT_EQ(std::get<Sphere>(zone.shape).radius, 1.5f);
    expect_near(zone.pose.position, {0.0f, 2.0f, 0.0f});
    EXPECT_FALSE(scene.bodies[1].definition.sensor);
    EXPECT_TRUE(scene.bodies[2].definition.sensor);
    EXPECT_EQ(scene.bodies[2].name, "both (2)");
    EXPECT_TRUE(scene.bodies[3].definition.sensor);
    EXPECT_EQ(scene.bodies[3].definition.kind, BodyKind::Kinematic);
    expect_near(scene.bodies[3].definition.velocity.linear, {1.0f, 0.0f, 0.0f});
    EXPECT_TRUE(scene.bodies[5].definition.sensor);
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(gltf, triggers_report_what_falls_through_them) {
    const Scene scene = read(document(R"({"translation":[0,-2,0],)" + physics(R"("trigger":{"geometry":{"shape":0}})") +
                                      "},{" + physics(R"("motion":{},)" + collider("1")) + "}"));
    WorldOptions options;
    options.device = DeviceKind::Cpu;
    World world(scene.settings, options);
    for (const NamedBody& body : scene.bodies)
        world.add(body.definition);
    world.watch_contacts(ContactWatch::Changes);
    world.step(90);
    const std::vector<ContactEvent> events = world.take_contact_events();
    ASSERT_EQ(events.size(), 2u);
    EXPECT_TRUE(events[0].sensor);
    EXPECT_EQ(events[0].phase, ContactPhase::Begin);
    EXPECT_EQ(events[1].phase, ContactPhase::End);
    EXPECT_LT(world.pose(world.bodies()[1]).position.y, -9.0f); // it fell freely
}

TEST(gltf, what_is_left_out_without_harm_is_named_once) {
    const std::string mesh = physics(R"("trigger":{"geometry":{"mesh":4}})");
    const std::string trigger = R"("trigger":{"geometry":{"shape":0}})";
    const Scene scene = read(document(
        "{" + physics(collider()) + R"(},{"name":"door",)" + mesh + R"(},{"name":"gate",)" + mesh +
            R"(},{"name":"ghost",)" + physics(R"("motion":{})") + R"(},{"name":"off","scale":[0,0,0],)" +
            physics(collider()) + R"(},{"name":"car",)" + physics(R"("motion":{},)" + collider() + "," + trigger) +
            R"(},{"name":"picky",)" + physics(R"("trigger":{"geometry":{"shape":0},"collisionFilter":0})") + "}",
        R"(,"animations":[{}],"extensionsUsed":["OMI_physics_body"])"));
    EXPECT_EQ(scene.bodies.size(), 3u);
    EXPECT_EQ(scene.warnings,
              (std::vector<std::string>{
                  "1 animation is left out: only forces, contacts and velocities move bodies",
                  "OMI_physics_body: left out; only KHR_physics_rigid_bodies is read",
                  "2 triggers (door, gate) left out: of another shape than box or sphere",
                  "1 trigger (car) left out: carried by a motion that has another shape; a body of Talus has one",
                  "1 trigger (picky) with a collision filter, which is left out: it reports all bodies",
                  "1 motion (ghost) left out: no collider, so nothing can touch it",
                  "1 shape (off) left out: a scale of 0 turns it off",
              }));
}

TEST(gltf, filters_are_taken_where_they_keep_nothing_apart) {
    const auto body = [](const std::string& filter, bool moves, const std::string& name) {
        return R"({"name":")" + name + R"(",)" +
               physics(std::string(moves ? R"("motion":{},)" : "") +
                       R"("collider":{"geometry":{"shape":0},"collisionFilter":)" + filter + "}") +
               "}";
    };
    EXPECT_EQ(read(document(body("0", true, "a") + "," + body("0", false, "b"))).bodies.size(), 2u);
    EXPECT_EQ(read(document(body("0", false, "a") + "," + body("1", false, "b"))).bodies.size(), 2u);
    EXPECT_EQ(read(document(body("2", true, "a") + "," + body("3", true, "b"))).bodies.size(), 2u);
    EXPECT_NE(error_of(document(body("0", true, "a") + "," + body("1", false, "b")))
                  .find("node 0 'a': a collision filter keeps it apart from 'b'"),
              std::string::npos);
    EXPECT_NE(error_of(document(body("2", true, "a") + "," + body("2", true, "b")))
                  .find("node 0 'a': a collision filter keeps it apart from 'b'"),
              std::string::npos);
    EXPECT_NE(error_of(document(body("9", true, "a"))).find("9 is out of range: the file has 4 collision filters"),
              std::string::npos);
}

TEST(gltf, bounds_hold_the_bodies_and_the_camera_looks_at_them) {
    const Scene scene = read(document(R"({"translation":[0,7,0],)" + physics(R"("motion":{},)" + collider()) + "}"));
    EXPECT_NEAR(scene.bounds.lower.y, 6.0f - 50.0f, 1e-4f);
    EXPECT_LT(scene.bounds.lower.x, -50.0f);
    EXPECT_GT(scene.bounds.upper.z, 50.0f);
    expect_near(scene.camera.target, {0.0f, 7.0f, 0.0f});
}

TEST(gltf, refusals_name_the_node_and_the_reason) {
    const std::string moving = R"("motion":{},)";
    const std::vector<std::pair<std::string, std::string>> cases{
        {"{\"name\":\"pill\"," + physics(moving + collider("2")) + "}",
         ": node 0 'pill', collider: its shape is a capsule; Talus has boxes and spheres"},
        {"{" + physics(R"("collider":{"geometry":{"node":3}})") + "}", "its shape is a mesh"},
        {"{" + physics(R"("collider":{"geometry":{"mesh":3,"convexHull":true}})") + "}", "the convex hull of a mesh"},
        {"{" + physics(R"("collider":{"geometry":{"mesh":3,"shape":0}})") + "}", "names both a shape and a mesh"},
        {"{" + physics(R"("collider":{"geometry":{}})") + "}", "names no shape"},
        {"{" + physics(R"("collider":{})") + "}", "node 0, collider: has no 'geometry'"},
        {"{" + physics(collider("4")) + "}", "shape 4: the box's size along y must be positive and finite, not -2"},
        {"{" + physics(collider("5")) + "}", "shape 5: the sphere's radius must be positive"},
        {"{" + physics(collider("6")) + "}", "6 is out of range: the file has 6 shapes"},
        {"{" + physics(collider("-1")) + "}", "-1 is not an index"},
        {"{" + physics(collider("\"0\"")) + "}", "must be a number, not string"},
        {"{\"scale\":[1,2,1]," + physics(collider("1")) + "}", "makes it an ellipsoid"},
        {"{\"scale\":[1,0,1]," + physics(collider()) + "}", "its scale is zero along some axes"},
        {"{\"scale\":[1,2,1],\"children\":[1]},{\"name\":\"leaning\",\"rotation\":[0,0,0.38268343,0.92387953]," +
             physics(collider()) + "}",
         "node 1 'leaning': is sheared"},
        {"{\"name\":\"cart\",\"children\":[1,2]," + physics("\"motion\":{}") + "},{\"name\":\"l\"," +
             physics(collider()) + "},{\"name\":\"r\"," + physics(collider()) + "}",
         "node 0 'cart': its motion carries 2 colliders ('l', 'r'...)"},
        {"{\"name\":\"hinge\"," + physics(R"("joint":{"joint":0,"connectedNode":0})") + "}",
         "node 0 'hinge': is a joint"},
        {"{" + physics(R"("motion":{"mass":-1},)" + collider()) + "}", "motion, mass: must not be negative"},
        {"{" + physics(R"("motion":{"mass":"heavy"},)" + collider()) + "}", "must be a number, not string"},
        {"{" + physics(R"("motion":{"mass":1e300},)" + collider()) + "}", "is too large"},
        {"{" + physics(R"("motion":{"mass":1e-300},)" + collider()) + "}", "is too small"},
        {"{" + physics(R"("motion":{"isKinematic":1},)" + collider()) + "}", "must be true or false, not number"},
        {"{" + physics(R"("motion":{"mass":1,"inertiaDiagonal":[0,0,0]},)" + collider()) + "}", "infinite inertia"},
        {"{" + physics(R"("motion":{"mass":1,"inertiaDiagonal":[1,0,1]},)" + collider()) + "}", "about some axes only"},
        {"{" + physics(R"("motion":{"mass":0,"inertiaDiagonal":[1,1,1]},)" + collider()) + "}", "but a finite inertia"},
        {"{" + physics(R"("motion":{"linearVelocity":[1,2]},)" + collider()) + "}", "must have 3 numbers, not 2"},
        {"{" + physics(R"("collider":{"geometry":{"shape":0},"physicsMaterial":6})") + "}", "6 physics materials"},
        {"{" + physics(R"("collider":{"geometry":{"shape":0},"physicsMaterial":3})") + "}", "not 'mean'"},
        {"{" + physics(R"("collider":{"geometry":{"shape":0},"physicsMaterial":4})") + "}", "must not be negative"},
        {"{" + physics(R"("collider":{"geometry":{"shape":0},"physicsMaterial":5})") + "}", "must be from 0 to 1"},
        {R"({"translation":"here"})", "node 0, translation: must be an array, not string"},
        {R"({"rotation":[0,0,0,0]})", "is not a unit quaternion"},
        {R"({"rotation":[0,0,1]})", "must have 4 numbers, not 3"},
        {R"({"matrix":[1,0,0]})", "must have 16 numbers, not 3"},
        {R"({"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,2]})", "its fourth row must be 0, 0, 0, 1"},
        {R"({"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],"scale":[1,1,1]})", "has both a matrix and"},
        {R"({"children":[7]})", "7 is out of range: the file has 1 nodes"},
        {R"({"children":[1]},{"children":[2]},{"children":[1]})", "stands at two places of the node tree"},
        {R"({"name":5})", "must be a string, not number"},
        {"{}", "has no body"},
    };
    for (const auto& [nodes, expected] : cases) {
        const std::string error = error_of(document(nodes));
        EXPECT_NE(error.find(expected), std::string::npos) << expected << "\n" << error;
        EXPECT_NE(error.find("talus_gltf_test_"), std::string::npos) << "the file is not named: " << error;
    }
}

TEST(gltf, files_that_are_no_gltf_are_refused) {
    const std::vector<std::pair<std::string, std::string>> cases{
        {"", "it is empty"},
        {"solid cube", "its JSON is broken"},
        {R"({"asset":{"version":"2.0"},"nodes":[)", "its JSON is broken"},
        {R"({"asset":{"version":"2.0"},"nodes":[1e999]})", "its JSON is broken"},
        {"[]", "its JSON is not an object"},
        {"{}", "it has no 'asset'"},
        {R"({"asset":{}})", "names no version"},
        {R"({"asset":{"version":"1.0"}})", "it is glTF 1.0"},
        {R"({"asset":{"version":"2.0"},"nodes":{}})", "nodes: must be an array, not object"},
        {R"({"asset":{"version":"2.0"},"extensions":7,"nodes":[]})", "extensions: must be an object, not number"},
        {R"({"asset":{"version":"2.0"},"scene":3,"scenes":[{}],"nodes":[]})", "the file has 1 scenes"},
        {R"({"asset":{"version":"2.0"},"nodes":[]})", "has no body"},
        {R"({"asset":{"version":"2.0"},"extensionsUsed":["OMI_physics_body"]})", "it uses OMI_physics_body"},
    };
    for (const auto& [content, expected] : cases)
        EXPECT_NE(error_of(content).find(expected), std::string::npos) << content << "\n" << error_of(content);
    try {
        make_scene((std::filesystem::temp_directory_path() / "talus_no_such_file.glb").string());
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("there is no such file"), std::string::npos);
    }
}

/// A .glb around this JSON, padded as the format asks for.
std::string binary(std::string json) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const auto word = [](std::size_t value) {
        std::string bytes;
        for (int i = 0; i < 4; ++i)
            bytes += static_cast<char>((value >> (8 * i)) & 0xff);
        return bytes;
    };
    return "glTF" + word(2) + word(20 + json.size()) + word(json.size()) + "JSON" + json;
}

TEST(gltf, binary_files_are_read_and_cut_ones_refused) {
    const std::string whole = binary(document("{" + physics(collider()) + "}"));
    EXPECT_EQ(read(whole, ".glb").bodies.size(), 1u);
    EXPECT_EQ(read(whole, ".GLB").bodies.size(), 1u);
    for (std::size_t length = 0; length < whole.size(); ++length)
        EXPECT_NE(error_of(whole.substr(0, length), ".glb"), "no error") << length;
    std::string too_long = whole;
    too_long[15] = '\x7f'; // the JSON's length
    EXPECT_NE(error_of(too_long, ".glb").find("it ends within its JSON"), std::string::npos);
    EXPECT_NE(error_of("{}", ".glb").find("not binary glTF"), std::string::npos);
}

/// Calls `visit` with each copy of `whole` in which one value, `part` or one inside it, is another.
template <typename Visit> void for_each_change(nlohmann::json& whole, nlohmann::json& part, const Visit& visit) {
    static const std::vector<nlohmann::json> k_replacements{
        nullptr, true, "text", -1, 0, 1e30, 1e300, 0.5, nlohmann::json::array(), nlohmann::json::object()};
    const nlohmann::json original = part;
    for (const nlohmann::json& replacement : k_replacements) {
        part = replacement;
        visit(whole);
    }
    part = original;
    if (part.is_structured())
        for (nlohmann::json& inner : part)
            for_each_change(whole, inner, visit);
}

TEST(gltf, any_one_value_changed_gives_a_scene_or_an_error) {
    const std::string body = physics(
        R"("motion":{"mass":1,"isKinematic":false,"centerOfMass":[0,0,0],"inertiaDiagonal":[1,1,1],)"
        R"("inertiaOrientation":[0,0,0,1],"linearVelocity":[1,0,0],"angularVelocity":[0,1,0],"gravityFactor":1},)"
        R"("collider":{"geometry":{"shape":0},"physicsMaterial":1,"collisionFilter":0})");
    nlohmann::json whole = nlohmann::json::parse(document(
        R"({"name":"top","children":[1],"scale":[2,2,2],"rotation":[0,0,0,1],"translation":[1,2,3]},{"name":"a",)" +
            body + R"(},{"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],)" + body + "}",
        R"(,"scene":0,"scenes":[{"nodes":[0,2]}],"animations":[],"extensionsUsed":["KHR_physics_rigid_bodies"])"));
    int scenes = 0, errors = 0;
    for_each_change(whole, whole, [&](const nlohmann::json& changed) {
        try {
            const Scene scene = read(changed.dump());
            ++scenes;
            for (const NamedBody& named : scene.bodies) {
                const BodyDefinition& b = named.definition;
                EXPECT_TRUE(std::isfinite(b.pose.position.x + b.pose.rotation.w + b.velocity.linear.x)) << changed;
                if (const Box* box = std::get_if<Box>(&b.shape)) {
                    EXPECT_TRUE(box->size.x > 0.0f && std::isfinite(box->size.x)) << changed;
                }
            }
        } catch (const Error&) {
            ++errors;
        }
    });
    EXPECT_GT(scenes, 100);
    EXPECT_GT(errors, 1000);
}

} // namespace
} // namespace talus::scenes
