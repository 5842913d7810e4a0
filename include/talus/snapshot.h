// SPDX-License-Identifier: MIT
// Snapshots: all that a world's future depends on, so that it can go back. docs/snapshot.md describes the file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>

#include <talus/export.h>
#include <talus/types.h>

namespace talus {

namespace engine {
struct SavedState;
}

/// A world as it was: its bodies, its settings, the forces that wait for the next step, and what the solver remembers
/// of the last one. `World::snapshot` makes it. A copy costs nothing: the content is shared, and never changes.
class TALUS_API Snapshot {
public:
    /// Reads a file that `save` wrote. Throws Error where it cannot be read, is no snapshot, is damaged, or is of
    /// another version, and says which.
    static Snapshot load(const std::filesystem::path&);
    /// Writes all or nothing; an existing file is replaced. Throws Error where it cannot be written.
    void save(const std::filesystem::path&) const;

    std::uint64_t step() const noexcept;     ///< how many steps the world had made
    std::size_t body_count() const noexcept; ///< that the world had
    std::size_t bytes() const noexcept;      ///< of memory that it holds

private:
    friend class World;
    explicit Snapshot(std::shared_ptr<const engine::SavedState> saved) : state_(std::move(saved)) {}
    std::shared_ptr<const engine::SavedState> state_;
};

} // namespace talus
