// SPDX-License-Identifier: MIT
// Recordings. A frame is stored as the difference of its words from the frame before, split into planes of bytes that
// change alike, and compressed: lossless, and small where bodies rest. docs/recording.md describes the format; the two
// files change together, with k_version.
#include <talus/recording.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <fstream>
#include <limits>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>
#include <zstd.h>

namespace talus {
namespace {

namespace fs = std::filesystem;
using Bytes = std::string;

constexpr std::string_view k_magic = "TALUSREC";
constexpr std::string_view k_end_magic = "TALUSEND";
constexpr std::uint32_t k_version = 1;
constexpr std::string_view k_header_tag = "HEAD";
constexpr std::string_view k_key_tag = "KEYF";
constexpr std::string_view k_delta_tag = "DELT";
constexpr std::string_view k_index_tag = "INDX";
constexpr std::size_t k_preamble_size = 12;  // magic, version
constexpr std::size_t k_block_head_size = 8; // tag, size
constexpr std::size_t k_trailer_size = 16;   // offset of the index, end magic
constexpr std::size_t k_key_frame_interval = 64;
constexpr std::size_t k_words = 7; // of a pose
constexpr int k_compression_level = 3;

void put_u32(Bytes& out, std::uint32_t value) {
    for (int shift = 0; shift < 32; shift += 8)
        out.push_back(static_cast<char>(value >> shift & 0xffu));
}

void put_u64(Bytes& out, std::uint64_t value) {
    put_u32(out, static_cast<std::uint32_t>(value));
    put_u32(out, static_cast<std::uint32_t>(value >> 32));
}

void put_float(Bytes& out, float value) {
    put_u32(out, std::bit_cast<std::uint32_t>(value));
}

void put_string(Bytes& out, std::string_view text) {
    put_u32(out, static_cast<std::uint32_t>(text.size()));
    out.append(text);
}

/// Takes values off the front of a block's content. Running past the end means a damaged file.
class Cursor {
public:
    explicit Cursor(std::string_view bytes) : rest(bytes) {}

    std::string_view take(std::size_t size) {
        if (size > rest.size()) throw Error("a block is shorter than what it says it holds");
        const std::string_view front = rest.substr(0, size);
        rest.remove_prefix(size);
        return front;
    }
    std::uint8_t u8() { return static_cast<std::uint8_t>(take(1)[0]); }
    std::uint32_t u32() {
        const std::string_view bytes = take(4);
        std::uint32_t value = 0;
        for (int i = 3; i >= 0; --i)
            value = value << 8 | static_cast<std::uint8_t>(bytes[static_cast<std::size_t>(i)]);
        return value;
    }
    std::uint64_t u64() {
        const std::uint64_t low = u32();
        return low | std::uint64_t{u32()} << 32;
    }
    float f32() { return std::bit_cast<float>(u32()); }
    std::string string() { return std::string(take(u32())); }
    std::size_t remaining() const { return rest.size(); }

private:
    std::string_view rest;
};

using PoseWords = std::array<std::uint32_t, k_words>;
static_assert(sizeof(Pose) == sizeof(PoseWords), "a pose is seven floats without gaps");

/// Small steps in either direction become small numbers, so that the high bytes of a difference are mostly zero.
std::uint32_t zigzag(std::uint32_t difference) {
    return difference << 1 ^ (0u - (difference >> 31));
}
std::uint32_t unzigzag(std::uint32_t code) {
    return code >> 1 ^ (0u - (code & 1u));
}

/// Byte b of word w of body i lands at (4·w + b)·count + i.
Bytes encode_frame(std::uint64_t number, std::span<const PoseWords> words, std::span<const PoseWords> before) {
    Bytes out;
    put_u64(out, number);
    const std::size_t count = words.size();
    const std::size_t base = out.size();
    out.resize(base + count * sizeof(PoseWords));
    for (std::size_t w = 0; w < k_words; ++w) {
        char* plane = out.data() + base + 4 * w * count;
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint32_t code = zigzag(words[i][w] - before[i][w]);
            for (std::size_t b = 0; b < 4; ++b)
                plane[b * count + i] = static_cast<char>(code >> 8 * b & 0xffu);
        }
    }
    return out;
}

/// `words` holds the frame before (zeros at a key frame) and becomes this one.
void decode_frame(std::string_view planes, std::span<PoseWords> words) {
    const std::size_t count = words.size();
    for (std::size_t w = 0; w < k_words; ++w) {
        const char* plane = planes.data() + 4 * w * count;
        for (std::size_t i = 0; i < count; ++i) {
            std::uint32_t code = 0;
            for (std::size_t b = 0; b < 4; ++b)
                code |= std::uint32_t{static_cast<std::uint8_t>(plane[b * count + i])} << 8 * b;
            words[i][w] += unzigzag(code);
        }
    }
}

Bytes encode_header(const RecordingHeader& header) {
    Bytes out;
    put_string(out, header.scene);
    put_float(out, header.dt);
    put_u32(out, static_cast<std::uint32_t>(header.bodies.size()));
    for (const RecordedBody& body : header.bodies) {
        put_string(out, body.name);
        out.push_back(static_cast<char>(body.kind));
        out.push_back(static_cast<char>(body.shape.index()));
        if (const Box* box = std::get_if<Box>(&body.shape)) {
            put_float(out, box->size.x);
            put_float(out, box->size.y);
            put_float(out, box->size.z);
        } else {
            put_float(out, std::get<Sphere>(body.shape).radius);
        }
    }
    return out;
}

RecordingHeader decode_header(std::string_view content) {
    Cursor cursor(content);
    RecordingHeader header;
    header.scene = cursor.string();
    header.dt = cursor.f32();
    const std::uint32_t body_count = cursor.u32();
    for (std::uint32_t i = 0; i < body_count; ++i) {
        RecordedBody& body = header.bodies.emplace_back();
        body.name = cursor.string();
        const std::uint8_t kind = cursor.u8();
        if (kind > static_cast<std::uint8_t>(BodyKind::Kinematic))
            throw Error("body " + std::to_string(i) + " has the unknown kind " + std::to_string(kind));
        body.kind = static_cast<BodyKind>(kind);
        const std::uint8_t shape = cursor.u8();
        if (shape == 0) {
            const float x = cursor.f32(), y = cursor.f32(), z = cursor.f32();
            body.shape = Box{{x, y, z}};
        } else if (shape == 1) {
            body.shape = Sphere{cursor.f32()};
        } else {
            throw Error("body " + std::to_string(i) + " has the unknown shape " + std::to_string(shape));
        }
    }
    if (cursor.remaining() != 0) throw Error("the header is longer than what it holds");
    return header;
}

struct CompressorDeleter {
    void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
};

std::string system_reason() {
    return std::error_code(errno, std::generic_category()).message();
}

} // namespace

// ---- writing ----

struct RecordingWriter::Impl {
    fs::path path, temporary;
    std::ofstream file;
    std::unique_ptr<ZSTD_CCtx, CompressorDeleter> compressor{ZSTD_createCCtx()};
    std::uint64_t offset = 0;
    std::vector<std::uint64_t> frame_offsets;
    std::vector<PoseWords> before;
    bool finished = false;

    [[noreturn]] void fail(const std::string& what) const { throw Error("recording " + path.string() + ": " + what); }

    void append(std::string_view bytes) {
        errno = 0;
        if (!file.write(bytes.data(), static_cast<std::streamsize>(bytes.size())))
            fail("cannot be written: " + (errno != 0 ? system_reason() : "unknown reason"));
        offset += bytes.size();
    }

    void append_block(std::string_view tag, const Bytes& content) {
        Bytes block(k_block_head_size + ZSTD_compressBound(content.size()), '\0');
        const std::size_t size = ZSTD_compress2(compressor.get(), block.data() + k_block_head_size,
                                                block.size() - k_block_head_size, content.data(), content.size());
        if (ZSTD_isError(size) != 0) fail(std::string("cannot be compressed: ") + ZSTD_getErrorName(size));
        if (size > std::numeric_limits<std::uint32_t>::max()) fail("a frame is larger than 4 GiB");
        Bytes head(tag);
        put_u32(head, static_cast<std::uint32_t>(size));
        block.replace(0, k_block_head_size, head);
        block.resize(k_block_head_size + size);
        append(block);
    }
};

RecordingWriter::RecordingWriter(const fs::path& path, const RecordingHeader& header) : impl_(new Impl) {
    impl_->path = path;
    std::error_code ignored;
    // Of a link too the rename would take the place.
    if (const fs::file_status status = fs::symlink_status(path, ignored);
        fs::exists(status) && !fs::is_regular_file(status))
        impl_->fail("cannot be written: there is something of that name which is not a file");
    impl_->temporary = path;
    impl_->temporary.replace_filename(fmt::format(".{}.{}.partial", path.filename().string(), getpid()));
    ZSTD_CCtx_setParameter(impl_->compressor.get(), ZSTD_c_compressionLevel, k_compression_level);
    ZSTD_CCtx_setParameter(impl_->compressor.get(), ZSTD_c_checksumFlag, 1);

    errno = 0;
    impl_->file.open(impl_->temporary, std::ios::binary | std::ios::trunc);
    if (!impl_->file) impl_->fail("cannot be written: " + system_reason());
    try {
        Bytes preamble(k_magic);
        put_u32(preamble, k_version);
        impl_->append(preamble);
        impl_->append_block(k_header_tag, encode_header(header));
    } catch (...) {
        fs::remove(impl_->temporary, ignored);
        throw;
    }
    impl_->before.resize(header.bodies.size());
}

RecordingWriter::~RecordingWriter() {
    if (impl_->finished) return;
    impl_->file.close();
    std::error_code ignored;
    fs::remove(impl_->temporary, ignored);
}

void RecordingWriter::write(std::span<const Pose> poses) {
    if (impl_->finished) impl_->fail("a frame was given after finish()");
    if (poses.size() != impl_->before.size())
        impl_->fail("a frame has " + std::to_string(poses.size()) + " poses, but the header names " +
                    std::to_string(impl_->before.size()) + " bodies");
    const std::uint64_t number = impl_->frame_offsets.size();
    const bool key = number % k_key_frame_interval == 0;
    if (key) impl_->before.assign(poses.size(), {});

    std::vector<PoseWords> words(poses.size());
    for (std::size_t i = 0; i < poses.size(); ++i)
        words[i] = std::bit_cast<PoseWords>(poses[i]);
    const std::uint64_t start = impl_->offset;
    impl_->append_block(key ? k_key_tag : k_delta_tag, encode_frame(number, words, impl_->before));
    impl_->frame_offsets.push_back(start);
    impl_->before = std::move(words);
}

void RecordingWriter::finish() {
    if (impl_->finished) return;
    const std::uint64_t index_offset = impl_->offset;
    Bytes index;
    put_u64(index, impl_->frame_offsets.size());
    for (const std::uint64_t start : impl_->frame_offsets)
        put_u64(index, start);
    impl_->append_block(k_index_tag, index);
    Bytes trailer;
    put_u64(trailer, index_offset);
    trailer.append(k_end_magic);
    impl_->append(trailer);

    errno = 0;
    impl_->file.close();
    if (!impl_->file) impl_->fail("cannot be written: " + system_reason());
    std::error_code error;
    fs::rename(impl_->temporary, impl_->path, error);
    if (error) impl_->fail("cannot be put in place: " + error.message());
    impl_->finished = true;
}

// ---- reading ----

struct RecordingReader::Impl {
    fs::path path;
    std::ifstream file;
    RecordingHeader header;
    std::uint64_t header_end = 0;
    std::vector<std::uint64_t> frame_offsets; // and the index's own at the end
    std::size_t next_frame = 0;
    std::vector<PoseWords> words;

    [[noreturn]] void fail(const std::string& what) const { throw Error("recording " + path.string() + ": " + what); }

    Bytes read(std::uint64_t offset, std::size_t size) {
        Bytes bytes(size, '\0');
        file.clear();
        file.seekg(static_cast<std::streamoff>(offset));
        if (!file.read(bytes.data(), static_cast<std::streamsize>(size))) fail("ends early, or cannot be read");
        return bytes;
    }

    struct Block {
        std::string tag;
        Bytes content;
        std::uint64_t end = 0; ///< offset of what follows
    };

    /// The block at `offset`, which must end at or before `limit`.
    Block read_block(std::uint64_t offset, std::uint64_t limit, const std::string& what) {
        if (offset > limit || limit - offset < k_block_head_size) fail("is damaged: no room for " + what);
        const Bytes head = read(offset, k_block_head_size);
        Cursor cursor(head);
        Block block;
        block.tag = std::string(cursor.take(4));
        const std::uint32_t size = cursor.u32();
        block.end = offset + k_block_head_size + size;
        if (block.end > limit) fail("is damaged: " + what + " does not fit in the file");
        const Bytes packed = read(offset + k_block_head_size, size);

        // Zstandard cannot shrink data by more than about this factor: a larger claim is damage, not worth its memory.
        constexpr std::uint64_t k_largest_ratio = 1u << 17;
        const unsigned long long content_size = ZSTD_getFrameContentSize(packed.data(), packed.size());
        if (content_size == ZSTD_CONTENTSIZE_ERROR || content_size == ZSTD_CONTENTSIZE_UNKNOWN ||
            content_size > size * k_largest_ratio)
            fail("is damaged: " + what + " is not compressed as it should be");
        block.content.resize(content_size);
        const std::size_t result =
            ZSTD_decompress(block.content.data(), block.content.size(), packed.data(), packed.size());
        if (ZSTD_isError(result) != 0) fail("is damaged: " + what + ": " + ZSTD_getErrorName(result));
        if (result != content_size) fail("is damaged: " + what + " has the wrong size");
        return block;
    }

    void read_index(std::uint64_t offset, std::uint64_t limit) {
        const Block block = read_block(offset, limit, "the index");
        if (block.tag != k_index_tag || block.end != limit) fail("is damaged: the index is not where it should be");
        Cursor cursor(block.content);
        const std::uint64_t count = cursor.u64();
        if (cursor.remaining() / 8 != count || cursor.remaining() % 8 != 0)
            fail("is damaged: the index does not list as many frames as it says");
        std::uint64_t expected = header_end;
        for (std::uint64_t i = 0; i < count; ++i) {
            frame_offsets.push_back(cursor.u64());
            const bool in_order = i == 0 ? frame_offsets[0] == expected : frame_offsets[i] > expected;
            if (!in_order || frame_offsets[i] >= offset) fail("is damaged: the index names a wrong place");
            expected = frame_offsets[i];
        }
        frame_offsets.push_back(offset);
    }
};

RecordingReader::RecordingReader(const fs::path& path) : impl_(new Impl) {
    Impl& r = *impl_;
    r.path = path;
    std::error_code error;
    if (!fs::exists(path, error)) r.fail("there is no such file");
    if (!fs::is_regular_file(path, error)) r.fail("is not a file");
    errno = 0;
    r.file.open(path, std::ios::binary);
    if (!r.file) r.fail("cannot be opened: " + system_reason());
    const std::uint64_t size = fs::file_size(path, error);
    if (error) r.fail("cannot be read: " + error.message());

    const Bytes magic = r.read(0, static_cast<std::size_t>(std::min<std::uint64_t>(size, k_magic.size())));
    if (magic != k_magic) r.fail("is not a Talus recording");
    if (size < k_preamble_size + k_trailer_size) r.fail("ends early");
    const Bytes version_bytes = r.read(k_magic.size(), 4);
    const std::uint32_t version = Cursor(version_bytes).u32();
    if (version != k_version)
        r.fail("has version " + std::to_string(version) + " of the format; this program reads version " +
               std::to_string(k_version));

    const std::uint64_t index_limit = size - k_trailer_size;
    const Bytes trailer = r.read(index_limit, k_trailer_size);
    Cursor cursor(trailer);
    const std::uint64_t index_offset = cursor.u64();
    if (cursor.take(k_end_magic.size()) != k_end_magic) r.fail("ends early: the last bytes are missing");

    const Impl::Block block = r.read_block(k_preamble_size, index_limit, "the header");
    if (block.tag != k_header_tag) r.fail("is damaged: it does not start with a header");
    try {
        r.header = decode_header(block.content);
    } catch (const Error& reason) {
        r.fail(std::string("is damaged: ") + reason.what());
    }
    r.header_end = block.end;
    r.words.resize(r.header.bodies.size());
    r.read_index(index_offset, index_limit);
    if (r.frame_offsets.front() != r.header_end) r.fail("is damaged: there is a gap after the header");
}

RecordingReader::~RecordingReader() = default;

const RecordingHeader& RecordingReader::header() const noexcept {
    return impl_->header;
}

std::size_t RecordingReader::frame_count() const noexcept {
    return impl_->frame_offsets.size() - 1;
}

std::vector<Pose> RecordingReader::next() {
    Impl& r = *impl_;
    if (r.next_frame == frame_count()) return {};
    const std::string what = "frame " + std::to_string(r.next_frame);
    const std::uint64_t limit = r.frame_offsets[r.next_frame + 1];
    const Impl::Block block = r.read_block(r.frame_offsets[r.next_frame], limit, what);
    const bool key = block.tag == k_key_tag;
    if (!key && block.tag != k_delta_tag) r.fail("is damaged: " + what + " is not marked as a frame");
    if (!key && r.next_frame == 0) r.fail("is damaged: the first frame builds on one before it");
    if (block.end != limit) r.fail("is damaged: there is a gap after " + what);
    if (block.content.size() != 8 + r.words.size() * sizeof(PoseWords))
        r.fail("is damaged: " + what + " has not as many poses as there are bodies");
    Cursor cursor(block.content);
    if (cursor.u64() != r.next_frame) r.fail("is damaged: " + what + " is another frame");

    if (key) r.words.assign(r.words.size(), {});
    decode_frame(cursor.take(cursor.remaining()), r.words);
    ++r.next_frame;
    std::vector<Pose> poses(r.words.size());
    for (std::size_t i = 0; i < poses.size(); ++i)
        poses[i] = std::bit_cast<Pose>(r.words[i]);
    return poses;
}

} // namespace talus
