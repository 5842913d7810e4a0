// SPDX-License-Identifier: MIT
// Physics on a thread of its own, with a context that shares its objects with the renderer's. The next step must not
// write while the renderer reads, so each frame is a copy on the GPU, in one of two buffers; fences say when a copy is
// there, and when it has been drawn. Here the renderer only looks how high the ball is.
#include <array>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <thread>

#include <talus/talus.h>

#include "headless_context.h"

namespace {

constexpr int k_frames = 60;
constexpr GLsizeiptr k_pose_bytes = 32;

struct Frame {
    GLuint poses = 0;
    GLsync copied = nullptr; // placed by the physics, waited for by the renderer
    GLsync drawn = nullptr;  // the other way round
    bool full = false;
};

std::array<Frame, 2> frames;
std::mutex mutex;
std::condition_variable changed;

/// Takes the frame once it is full, or once it is empty.
Frame take(int number, bool full) {
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return frames.at(number % 2).full == full; });
    return frames.at(number % 2);
}

void give(int number, const Frame& frame) {
    {
        const std::scoped_lock lock(mutex);
        frames.at(number % 2) = frame;
    }
    changed.notify_all();
}

void run_physics(const HeadlessContext& context) {
    context.make_current();
    talus::WorldOptions options;
    options.device = talus::DeviceKind::Gpu;
    options.gl_context = talus::GlContext::Current;
    talus::World world({}, options);
    talus::BodyDefinition ball;
    ball.shape = talus::Sphere{};
    ball.pose.position = {0.0f, 10.0f, 0.0f};
    world.add(ball);
    for (int i = 0; i < k_frames; ++i) {
        world.step();
        Frame frame = take(i, false);
        if (frame.drawn != nullptr) glWaitSync(frame.drawn, 0, GL_TIMEOUT_IGNORED); // the GPU waits, not this thread
        glDeleteSync(frame.drawn);
        glCopyNamedBufferSubData(world.gl_buffers().poses, frame.poses, 0, 0, k_pose_bytes);
        frame = {frame.poses, glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0), nullptr, true};
        glFlush(); // or the other context may wait for ever
        give(i, frame);
    }
}

void render() {
    for (int i = 0; i < k_frames; ++i) {
        Frame frame = take(i, true);
        glWaitSync(frame.copied, 0, GL_TIMEOUT_IGNORED);
        glDeleteSync(frame.copied);
        std::array<float, 3> position{}; // a renderer draws from frame.poses instead
        glGetNamedBufferSubData(frame.poses, 0, sizeof position, position.data());
        if ((i + 1) % 20 == 0) std::printf("frame %d: %.2f m\n", i + 1, position[1]);
        frame = {frame.poses, nullptr, glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0), false};
        glFlush();
        give(i, frame);
    }
}

} // namespace

int main() {
    try {
        const HeadlessContext renderer, physics(&renderer);
        renderer.make_current();
        for (Frame& frame : frames) {
            glCreateBuffers(1, &frame.poses);
            glNamedBufferStorage(frame.poses, k_pose_bytes, nullptr, 0);
        }
        std::thread thread(run_physics, std::cref(physics));
        render();
        thread.join();
    } catch (const std::exception& error) {
        std::fprintf(stderr, "second_thread: %s\n", error.what());
        return 1;
    }
}
