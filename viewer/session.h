// SPDX-License-Identifier: MIT
// A scene that plays: runs, pauses, goes a step on or back, starts anew, changes devices. It knows no window.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <talus/talus.h>

#include "scenes/scene.h"
#include "viewer/history.h"

namespace talus::viewer {

class Session {
public:
    using Adjust = std::function<Settings(const scenes::Scene&)>;

    /// The specification is a scene's, or the name of a snapshot's file (.snapshot), which then is the start.
    /// `settings` gives the settings to start with; a snapshot's own are in its scene. Worlds on a GPU use the context
    /// that is current. Throws Error where the scene, the snapshot or the device cannot be had.
    Session(const std::string& specification, DeviceKind, std::uint32_t threads, Adjust settings);

    /// Another scene, from its start; throws Error, and goes on with the one that there is, where it cannot be had.
    void open(const std::string& specification);
    /// From the start again, with the settings as they are now.
    void reset();
    /// Goes on where it is on another device; throws Error, and stays, where that cannot be had.
    void move_to(DeviceKind);

    bool running = true;
    double speed = 1.0; ///< simulated seconds for each second
    /// Called before each step: the place for forces that last. Returns whether it changed the world.
    std::function<bool(World&)> before_step;
    bool keep_past = true; ///< take snapshots, to step back to

    /// Makes the steps that are due after this much time; fewer where they take too long to keep up.
    void advance(std::chrono::duration<double> elapsed);
    void step();
    /// False where there is nothing to go back to.
    bool step_back();

    /// The world, for changing it by hand: what comes after cannot be had by stepping on from a snapshot before.
    World& change();
    void save(const std::filesystem::path&);
    /// Throws Error, and leaves the world, where the file is no snapshot.
    void load(const std::filesystem::path&);

    const World& world() const noexcept { return *simulated; }
    const scenes::Scene& scene() const noexcept { return source.scene; }
    DeviceKind device() const noexcept { return simulated->device().kind; }
    const History& history() const noexcept { return past; }
    /// Counts up whenever the bodies are no longer those that they were: another scene, another world.
    std::uint64_t generation() const noexcept { return world_number; }
    /// Simulated seconds for each second of the last while that it ran.
    double achieved_speed() const noexcept { return achieved; }

private:
    using Clock = std::chrono::steady_clock;

    /// Where playing starts.
    struct Start {
        scenes::Scene scene;              ///< of a snapshot: its name and a camera
        std::optional<Snapshot> snapshot; ///< in the place of the scene's bodies
    };

    static Start find_start(const std::string& specification);
    World make_world(const Settings&, DeviceKind) const;
    World world_at(const Start&, DeviceKind) const;
    void take(World&&);

    Adjust initial_settings;
    std::uint32_t threads;
    Start source;
    std::unique_ptr<World> simulated;
    History past;
    std::uint64_t world_number = 0;
    double due = 0.0; ///< simulated seconds that are owed
    double achieved = 0.0;
};

/// What `--device auto` means for a window: the GPU where its context is of one, otherwise the CPU.
DeviceKind device_for_window(DeviceKind wanted);

} // namespace talus::viewer
