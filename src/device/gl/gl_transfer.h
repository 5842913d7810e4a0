// SPDX-License-Identifier: MIT
// Bytes between the host and the state's buffers, by way of persistently mapped memory.
#pragma once

#include <array>
#include <span>

#include "device/device.h"
#include "device/gl/gl_objects.h"

namespace talus::engine {

/// Host to GPU. The copies take their place among the commands around them; the host waits only where it is a whole
/// ring ahead of the GPU.
class UploadRing {
public:
    UploadRing();
    void copy(GLuint target, std::size_t offset, std::span<const std::byte> bytes);
    /// Makes all bytes of a buffer from `offset` on zero.
    void zero(const GlBuffer& target, std::size_t offset = 0);
    std::size_t memory_bytes() const noexcept { return buffer_.size(); }

private:
    static constexpr std::size_t k_segment_bytes = std::size_t{1} << 18;
    static constexpr std::size_t k_segments = 4;

    GlBuffer buffer_;
    std::array<GlFence, k_segments> fences_; // placed after the last copy out of the segment
    std::size_t segment_ = 0;
    std::size_t used_ = 0; // bytes of the segment
};

/// GPU to host: all requests together, so that a small one has one wait. Of a large one a part leaves the GPU while the
/// host takes the part before it.
class ReadBack {
public:
    struct Request {
        GLuint source;
        std::size_t offset;
        std::size_t bytes;
        void* destination;
    };
    void read(std::span<const Request>);
    std::size_t memory_bytes() const noexcept { return buffer_.size(); }

private:
    static constexpr std::size_t k_segment_bytes = std::size_t{1} << 18;

    GlBuffer buffer_; // one segment or less, or two
};

} // namespace talus::engine
