// SPDX-License-Identifier: MIT
// Worlds beside a caller's own OpenGL context: after every call the thread has current what it had before, and other
// threads may go on with the world.
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include "device/gl/gl_context.h"
#include "state/buffers.h"
#include "tests/bodies.h"
#include "tests/devices.h"
#include "tests/gl_state.h"

namespace talus::tests {
namespace {

/// What a renderer has: a context that is current with a surface of its own.
class Renderer {
public:
    Renderer() {
        const auto opened = engine::OpenGlContext::own(); // knows which display works here
        opened->make_current();
        display = eglGetCurrentDisplay();
        constexpr EGLint wanted[]{EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_NONE};
        constexpr EGLint size[]{EGL_WIDTH, 16, EGL_HEIGHT, 16, EGL_NONE};
        EGLConfig config = nullptr;
        EGLint count = 0;
        eglChooseConfig(display, wanted, &config, 1, &count);
        EXPECT_EQ(count, 1);
        surface = eglCreatePbufferSurface(display, config, size);
        context = eglCreateContext(display, config, EGL_NO_CONTEXT, nullptr);
        EXPECT_EQ(eglMakeCurrent(display, surface, surface, context), static_cast<EGLBoolean>(EGL_TRUE));
        glGenBuffers(1, &buffer);
        glBindBuffer(GL_ARRAY_BUFFER, buffer);
    }
    ~Renderer() {
        eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(display, context);
        eglDestroySurface(display, surface);
    }
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    bool is_untouched() const {
        GLint bound = 0;
        if (eglGetCurrentContext() != context || eglGetCurrentSurface(EGL_DRAW) != surface) return false;
        glGetIntegerv(GL_ARRAY_BUFFER_BINDING, &bound);
        return static_cast<GLuint>(bound) == buffer && eglGetCurrentSurface(EGL_READ) == surface;
    }

private:
    EGLDisplay display;
    EGLSurface surface;
    EGLContext context;
    GLuint buffer = 0;
};

bool nothing_is_current() {
    return eglGetCurrentContext() == EGL_NO_CONTEXT;
}

/// A world, and every public call that may have to do with its device.
class Contexts : public OnDevice {
protected:
    void build() {
        WorldOptions options = options_on(GetParam());
        options.gl_context = gl_context;
        world.emplace(Settings{}, options);
        world->add(ground());
        box = world->add(box_at({0.0f, 0.5f, 0.0f}));
    }

    std::vector<std::pair<std::string, std::function<void()>>> calls() {
        return {
            {"World", [this] { build(); }},
            {"add",
             [this] {
                 world->add(box_at({3.0f, 0.5f, 0.0f}));
             }},
            {"step", [this] { world->step(3); }},
            {"wait", [this] { world->wait(); }},
            {"pose", [this] { world->pose(box); }},
            {"poses", [this] { world->poses(); }},
            {"velocity", [this] { world->velocity(box); }},
            {"velocities", [this] { world->velocities(); }},
            {"set_pose",
             [this] {
                 world->set_pose(box, {{0.0f, 0.5f, 0.1f}, {}});
             }},
            {"set_velocity",
             [this] {
                 world->set_velocity(box, {{0.0f, 0.5f, 0.0f}, {}});
             }},
            {"add_force",
             [this] {
                 world->add_force(box, {1.0f, 0.0f, 0.0f});
             }},
            {"add_force at",
             [this] {
                 world->add_force(box, {1.0f, 0.0f, 0.0f}, {});
             }},
            {"add_torque",
             [this] {
                 world->add_torque(box, {1.0f, 0.0f, 0.0f});
             }},
            {"add_impulse",
             [this] {
                 world->add_impulse(box, {1.0f, 0.0f, 0.0f});
             }},
            {"add_impulse at",
             [this] {
                 world->add_impulse(box, {1.0f, 0.0f, 0.0f}, {});
             }},
            {"add_angular_impulse",
             [this] {
                 world->add_angular_impulse(box, {1.0f, 0.0f, 0.0f});
             }},
            {"set_gravity_scale", [this] { world->set_gravity_scale(box, 0.5f); }},
            {"set_material", [this] { world->set_material(box, {}); }},
            {"collision_pairs", [this] { world->collision_pairs(); }},
            {"contacts", [this] { world->contacts(); }},
            {"report", [this] { world->report(); }},
            {"state_hash", [this] { world->state_hash(); }},
            {"keep_poses_coming", [this] { world->keep_poses_coming(true); }},
            {"newest_poses", [this] { world->newest_poses(); }},
            {"set_settings", [this] { world->set_settings(weightless()); }},
            {"memory", [this] { world->memory(); }},
            {"gl_buffers", [this] { world->gl_buffers(); }},
            {"gl_buffers with a change on its way",
             [this] {
                 world->set_pose(box, {{0.0f, 0.5f, 0.2f}, {}});
                 world->gl_buffers();
             }},
            {"snapshot", [this] { world->snapshot(); }},
            {"restore", [this] { world->restore(world->snapshot()); }},
            {"a call that is refused", [this] { error_of([this] { world->step(), world->pose({}); }); }},
            {"set_sensor", [this] { world->set_sensor(box, true); }},
            {"watch_contacts", [this] { world->watch_contacts(ContactWatch::All); }},
            {"step with events", [this] { world->step(3); }},
            {"take_finished_contact_events", [this] { world->take_finished_contact_events(); }},
            {"take_contact_events", [this] { world->take_contact_events(); }},
            {"remove", [this] { world->remove(box); }},
            {"operator=", [this] { *world = make_world(); }},
            {"list_devices", [] { list_devices(); }},
            {"~World", [this] { world.reset(); }},
        };
    }

    GlContext gl_context = GlContext::Own;
    std::optional<World> world;
    BodyId box;
};

TEST_P(Contexts, of_a_renderer_stay_current) {
    const Renderer renderer;
    for (const auto& [name, call] : calls()) {
        if (world) world->step(); // on its way, so that there is something to wait for
        call();
        ASSERT_TRUE(renderer.is_untouched()) << name;
    }
}

TEST_P(Contexts, are_not_left_where_none_was_current) {
    for (const auto& [name, call] : calls()) {
        if (world) world->step();
        call();
        ASSERT_TRUE(nothing_is_current()) << name;
    }
}

TEST_P(Contexts, of_a_world_stay_where_they_are_asked_for) {
    build();
    world->make_gl_current();
    const EGLContext of_world = eglGetCurrentContext();
    EXPECT_NE(of_world, EGL_NO_CONTEXT);
    world->step(3);
    world->poses();
    EXPECT_EQ(eglGetCurrentContext(), of_world);
    std::string refusal;
    std::thread([&] { refusal = error_of([this] { world->step(); }); }).join();
    EXPECT_NE(refusal.find("current on another thread (World::make_gl_current"), std::string::npos) << refusal;

    eglMakeCurrent(eglGetCurrentDisplay(), EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    std::thread([&] { refusal = error_of([this] { world->step(); }); }).join();
    EXPECT_EQ(refusal, "no error");
    EXPECT_EQ(world->step_count(), 4u);

    world->make_gl_current();
    world.reset();
    EXPECT_TRUE(nothing_is_current());
}

TEST_P(Contexts, of_the_caller_keep_all_their_state) {
    const Renderer renderer;
    set_unusual_gl_state();
    ASSERT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    const GlState before = gl_state();
    gl_context = GlContext::Current;
    for (const auto& [name, call] : calls()) {
        if (name == "operator=") continue; // it makes a world in a context of its own
        if (world) world->step();
        call();
        ASSERT_EQ(gl_state(), before) << name;
        ASSERT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR)) << name;
    }
}

TEST_P(Contexts, of_the_caller_must_be_current) {
    const Renderer renderer;
    gl_context = GlContext::Current;
    build();
    world->step(2);
    std::string refusal;
    std::thread([&] { refusal = error_of([this] { world->step(); }); }).join();
    EXPECT_NE(refusal.find("make it current before each call"), std::string::npos) << refusal;
    EXPECT_EQ(error_of([this] { world->step(); }), "no error");
    world.reset();
}

TEST_P(Contexts, of_the_caller_find_contacts_where_gl_buffers_says) {
    const Renderer renderer;
    gl_context = GlContext::Current;
    build();
    for (int i = 0; i < 3; ++i) {
        world->step(); // by which what is old and what is new change places
        const GlBuffers buffers = world->gl_buffers();
        std::vector<engine::Manifold> manifolds(buffers.pair_capacity);
        std::vector<engine::NormalImpulses> impulses(buffers.pair_capacity);
        const auto read = [](const GlRange& range, auto& records) {
            const std::size_t bytes = records.size() * sizeof records[0];
            ASSERT_LE(bytes, range.size);
            glGetNamedBufferSubData(range.buffer, static_cast<GLintptr>(range.offset), static_cast<GLsizeiptr>(bytes),
                                    records.data());
        };
        read(buffers.manifolds, manifolds);
        read(buffers.point_impulses, impulses);
        const std::vector<Contact> contacts = world->contacts();
        ASSERT_EQ(contacts.size(), 1u);
        ASSERT_EQ(manifolds.size(), 1u);
        EXPECT_EQ(manifolds[0].body_b, contacts[0].b.index);
        EXPECT_EQ(manifolds[0].point_count, contacts[0].points.size());
        EXPECT_EQ(manifolds[0].normal.y, contacts[0].normal.y);
        EXPECT_GT(impulses[0].normal[0], 0.0f);
    }
}

INSTANTIATE_TEST_SUITE_P(Devices, Contexts, testing::Values(DeviceKind::Gpu, DeviceKind::Hybrid),
                         [](const auto& test) { return name_of(test.param); });

class Threads : public OnDevice {};

TEST_P(Threads, may_take_turns_with_a_world) {
    World whole = make_world();
    whole.add(bodies_of("stack:height=5"));
    whole.step(40);

    std::optional<World> world;
    std::uint64_t hash = 0;
    const std::vector<std::function<void()>> turns{
        [&] { world.emplace(make_world()); },
        [&] { world->add(bodies_of("stack:height=5")); },
        [&] { world->step(15); },
        [&] { world->step(15); }, // behind steps that are on their way
        [&] { world->wait(); },
        [&] { world->step(10); },
        [&] { hash = world->state_hash(); },
        [&] { world.reset(); },
    };
    for (std::size_t i = 0; i < turns.size(); ++i) {
        std::string refusal;
        const auto take_turn = [&] { refusal = error_of(turns[i]); };
        if (i % 2 == 0)
            take_turn(); // a thread that lives on keeps what is current on it
        else
            std::thread(take_turn).join();
        EXPECT_EQ(refusal, "no error") << i;
    }
    EXPECT_EQ(hash, whole.state_hash());
}

TEST_P(Threads, may_have_a_world_each) {
    const auto hash_after = [this](std::uint32_t steps) {
        World world = make_world();
        world.add(bodies_of("stack:height=4"));
        for (std::uint32_t i = 0; i < steps; ++i)
            world.step();
        return world.state_hash();
    };
    std::uint64_t one = 0, other = 0;
    std::thread first([&] { one = hash_after(20); }), second([&] { other = hash_after(30); });
    first.join();
    second.join();
    EXPECT_EQ(one, hash_after(20));
    EXPECT_EQ(other, hash_after(30));
}

TALUS_ON_EVERY_DEVICE(Threads);

} // namespace
} // namespace talus::tests
