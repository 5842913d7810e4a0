// SPDX-License-Identifier: MIT
// See gl_transfer.h. All mappings are coherent, so the fences alone order the host's accesses and the GPU's.
#include "device/gl/gl_transfer.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <vector>

namespace talus::engine {
namespace {

constexpr GLbitfield k_mapped = GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
constexpr std::size_t k_alignment = 16;

std::size_t aligned(std::size_t bytes) {
    return (bytes + k_alignment - 1) / k_alignment * k_alignment;
}

} // namespace

UploadRing::UploadRing() : buffer_("UploadRing", k_segment_bytes * k_segments, GL_MAP_WRITE_BIT | k_mapped) {}

void UploadRing::copy(GLuint target, std::size_t offset, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        if (used_ == k_segment_bytes) {
            fences_[segment_] = GlFence::place();
            segment_ = (segment_ + 1) % k_segments;
            fences_[segment_].wait();
            used_ = 0;
        }
        const std::size_t source = segment_ * k_segment_bytes + used_;
        const std::size_t count = std::min(bytes.size(), k_segment_bytes - used_);
        std::memcpy(buffer_.mapped() + source, bytes.data(), count);
        glCopyNamedBufferSubData(buffer_.name(), target, static_cast<GLintptr>(source), static_cast<GLintptr>(offset),
                                 static_cast<GLsizeiptr>(count));
        used_ += aligned(count);
        offset += count;
        bytes = bytes.subspan(count);
    }
}

// Not by glClearNamedBufferSubData: where that is the first command for a large new buffer, NVIDIA's driver takes 0.85
// s for each GB of it, and 0.05 where a copy is.
void UploadRing::zero(const GlBuffer& target, std::size_t offset) {
    static constexpr std::array<std::byte, 64 * 1024> zeros{};
    const std::size_t bytes = target.size() - offset;
    std::size_t done = std::min(bytes, zeros.size());
    copy(target.name(), offset, std::span(zeros).first(done));
    while (done < bytes) {
        const std::size_t more = std::min(done, bytes - done);
        glCopyNamedBufferSubData(target.name(), target.name(), static_cast<GLintptr>(offset),
                                 static_cast<GLintptr>(offset + done), static_cast<GLsizeiptr>(more));
        done += more;
    }
}

void ReadBack::read(std::span<const Request> requests) {
    std::size_t total = 0;
    for (const Request& request : requests)
        total += aligned(request.bytes);
    if (total == 0) return;
    const std::size_t wanted = total <= k_segment_bytes ? std::bit_ceil(total) : 2 * k_segment_bytes;
    if (wanted > buffer_.size()) buffer_ = GlBuffer("ReadBack", wanted, GL_MAP_READ_BIT | k_mapped);

    struct Piece {
        std::size_t place;
        std::byte* destination;
        std::size_t bytes;
    };
    struct Segment {
        GlFence fence;
        std::vector<Piece> pieces;
    };
    std::array<Segment, 2> segments;
    const auto take = [&](Segment& segment) {
        segment.fence.wait();
        for (const Piece& piece : segment.pieces)
            std::memcpy(piece.destination, buffer_.mapped() + piece.place, piece.bytes);
        segment.pieces.clear();
    };
    std::size_t filling = 0, used = 0;
    for (const Request& request : requests) {
        for (std::size_t done = 0; done < request.bytes;) {
            if (used == k_segment_bytes) {
                segments[filling].fence = GlFence::place();
                filling = 1 - filling;
                take(segments[filling]);
                used = 0;
            }
            const std::size_t place = filling * k_segment_bytes + used;
            const std::size_t bytes = std::min(request.bytes - done, k_segment_bytes - used);
            glCopyNamedBufferSubData(request.source, buffer_.name(), static_cast<GLintptr>(request.offset + done),
                                     static_cast<GLintptr>(place), static_cast<GLsizeiptr>(bytes));
            segments[filling].pieces.push_back({place, static_cast<std::byte*>(request.destination) + done, bytes});
            used += aligned(bytes);
            done += bytes;
        }
    }
    segments[filling].fence = GlFence::place();
    take(segments[1 - filling]);
    take(segments[filling]);
}

} // namespace talus::engine
