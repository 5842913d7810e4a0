// SPDX-License-Identifier: MIT
// Snapshots in files: magic, version, then all lists of the state, compressed with a checksum. docs/snapshot.md
// describes the format; the two files change together, with k_version.
#include <talus/snapshot.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <string_view>
#include <system_error>
#include <type_traits>

#include <fmt/format.h>
#include <unistd.h>
#include <zstd.h>

#include "checks.h"
#include "saved_state.h"
#include "state/formulas.h"

namespace talus {
namespace {

namespace fs = std::filesystem;
using namespace engine;

constexpr std::string_view k_magic = "TALUSSNP";
constexpr std::uint32_t k_version = 22;
constexpr std::size_t k_head_size = 12; // magic, version
constexpr int k_compression_level = 3;

static_assert(std::endian::native == std::endian::little, "records are written as they lie in memory");
// A member more has to be written, or to follow from others, and k_version to be raised.
static_assert(sizeof(Settings) == 84 && offsetof(Settings, sleeping) == 80);
static_assert(sizeof(BodyTable) == 15 * sizeof(std::vector<int>) + 2 * sizeof(uint) + 2 * sizeof(std::size_t));

class Writer {
public:
    template <typename T> void value(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        content.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    /// Size of a record, number of records, records.
    template <typename T> void list(const std::vector<T>& records) {
        value(std::uint32_t{sizeof(T)});
        value(std::uint64_t{records.size()});
        content.append(reinterpret_cast<const char*>(records.data()), records.size() * sizeof(T));
    }
    std::string content;
};

class Reader {
public:
    explicit Reader(std::string_view bytes) : rest(bytes) {}

    template <typename T> void value(T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        std::memcpy(&value, take(sizeof value), sizeof value);
    }
    template <typename T> void list(std::vector<T>& records) {
        std::uint32_t stride = 0;
        std::uint64_t count = 0;
        value(stride);
        value(count);
        if (stride != sizeof(T) || count > rest.size() / sizeof(T)) throw Error("a list has the wrong size");
        records.resize(count);
        if (count > 0) std::memcpy(records.data(), take(count * sizeof(T)), count * sizeof(T));
    }
    bool at_end() const { return rest.empty(); }

private:
    const char* take(std::size_t size) {
        if (size > rest.size()) throw Error("it ends early");
        const char* front = rest.data();
        rest.remove_prefix(size);
        return front;
    }

    std::string_view rest;
};

/// As 32 bits, 0 or 1. `wrong`: what anything else in a file means.
template <typename File> bool visit_flag(File& file, bool flag, const char* wrong) {
    std::uint32_t word = flag ? 1 : 0;
    file.value(word);
    if (word > 1) throw Error(wrong);
    return word == 1;
}

/// All numbers as they lie in memory, but for the last member, which is not as large as a word.
template <typename File, typename S> void visit_settings(File& file, S& settings) {
    std::array<std::byte, offsetof(Settings, sleeping)> numbers;
    std::memcpy(numbers.data(), &settings, sizeof numbers);
    file.value(numbers);
    const bool sleeping = visit_flag(file, settings.sleeping, "its settings are wrong");
    if constexpr (!std::is_const_v<S>) {
        std::memcpy(static_cast<void*>(&settings), numbers.data(), sizeof numbers);
        settings.sleeping = sleeping;
    }
}

/// What a file holds, in order: for writing and for reading.
template <typename File, typename State> void visit(File& file, State& state) {
    visit_settings(file, state.settings);
    auto& report = state.report;
    file.value(report.step);
    for (auto* count : {&report.pairs, &report.manifolds, &report.contacts, &report.colours, &report.substeps,
                        &report.overflow_manifolds, &report.hubs, &report.frozen_bodies, &report.sleeping_bodies})
        file.value(*count);
    file.value(state.counters);
    const bool wakes_all = visit_flag(file, state.table.wakes_all(), "it does not say who wakes");
    if constexpr (!std::is_const_v<State>) {
        if (wakes_all) state.table.wake_all();
    }
    BodyTable::visit_lists(state.table, [&](auto& list) { file.list(list); });
    file.list(state.manifolds);
    file.list(state.points);
    file.list(state.separations);
    file.list(state.next_impulses);
    file.list(state.impulses);
    file.list(state.contact_states);
    file.list(state.starts);
    file.list(state.rests);
    file.list(state.boxes);
}

/// A file may have been made by anyone: indices that lead out of a list are refused here.
void check(SavedState& state) {
    check_settings(state.settings);
    if (const std::string wrong = state.table.complete(); !wrong.empty()) throw Error(wrong);
    const uint slots = state.table.slot_count();
    std::size_t point_count = 0;
    std::size_t solved_count = 0;
    uint touching = 0;
    for (const Manifold& manifold : state.manifolds) {
        if (manifold.body_a >= manifold.body_b || manifold.body_b >= slots || manifold.point_count > 4 ||
            manifold.colour > k_no_colour || substeps_of(manifold.demand) > 1000)
            throw Error("a manifold is not one of its bodies");
        const bool waits_too_long = idle_steps_of(manifold.demand) > k_growing + k_growing_steps;
        if (waits_too_long || !(manifold.weights >= 0.0f) || !(manifold.lasting_weights >= 0.0f))
            throw Error("a manifold has a load that none can have");
        point_count += manifold.point_count;
        if (!is_active(manifold)) continue;
        ++touching;
        solved_count += manifold.point_count;
    }
    std::vector<std::pair<uint, uint>> pairs;
    for (const Manifold& manifold : state.manifolds)
        pairs.emplace_back(manifold.body_a, manifold.body_b);
    std::ranges::sort(pairs);
    if (std::ranges::adjacent_find(pairs) != pairs.end()) throw Error("two bodies have two manifolds");
    const StepReport& report = state.report;
    const auto& counters = state.counters;
    if (state.points.size() != point_count || state.impulses.size() != point_count)
        throw Error("it has not as many points as its manifolds say");
    if (state.separations.size() != state.manifolds.size() || state.next_impulses.size() != state.manifolds.size())
        throw Error("it has not as many records of separations or impulses as manifolds");
    if (!std::ranges::all_of(state.separations, [](const Separations& each) { return each.way >= 0.0f; }))
        throw Error("a contact has lasted for a way that none can have");
    if (report.pairs != state.manifolds.size() || report.manifolds != touching || report.contacts != solved_count ||
        (!state.contact_states.empty() && state.contact_states.size() != report.pairs) ||
        state.starts.size() != slots || (!state.rests.empty() && state.rests.size() != slots) ||
        counters[k_counter_did_not_fit] != 0 || counters[k_counter_body_count] > slots ||
        counters[k_counter_old_pair_count] != report.pairs || counters[k_counter_pair_demand] != report.pairs ||
        counters[k_counter_search_count] != 0 || counters[k_counter_stray_count] != 0 ||
        counters[k_counter_added_pairs] > report.pairs || counters[k_counter_pairs_changed] != 0 ||
        counters[k_counter_searched_slots] != state.boxes.size() || state.boxes.size() > slots)
        throw Error("its counts do not go together");
}

[[noreturn]] void fail(const fs::path& path, const std::string& what) {
    throw Error("snapshot " + path.string() + ": " + what);
}

std::string system_reason() {
    return errno != 0 ? std::generic_category().message(errno) : "unknown reason";
}

std::string read_file(const fs::path& path) {
    std::error_code ignored;
    if (!fs::exists(path, ignored)) fail(path, "there is no such file");
    if (!fs::is_regular_file(path, ignored)) fail(path, "is not a file");
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    if (!file) fail(path, "cannot be opened: " + system_reason());
    std::string bytes{std::istreambuf_iterator<char>(file), {}};
    if (file.bad()) fail(path, "cannot be read: " + system_reason());
    return bytes;
}

std::string decompress(const fs::path& path, std::string_view packed) {
    // Zstandard cannot shrink data by more than about this factor: a larger claim is damage, not worth its memory.
    constexpr std::uint64_t k_largest_ratio = 1u << 17;
    const unsigned long long size = ZSTD_getFrameContentSize(packed.data(), packed.size());
    if (size == ZSTD_CONTENTSIZE_ERROR || size == ZSTD_CONTENTSIZE_UNKNOWN || size > packed.size() * k_largest_ratio)
        fail(path, "is damaged: its content is not compressed as it should be");
    std::string content(size, '\0');
    const std::size_t result = ZSTD_decompress(content.data(), content.size(), packed.data(), packed.size());
    if (ZSTD_isError(result) != 0) fail(path, std::string("is damaged: ") + ZSTD_getErrorName(result));
    return content;
}

} // namespace

Snapshot Snapshot::load(const fs::path& path) {
    const std::string bytes = read_file(path);
    if (!bytes.starts_with(k_magic)) fail(path, "is not a Talus snapshot");
    if (bytes.size() < k_head_size) fail(path, "ends early");
    std::uint32_t version = 0;
    std::memcpy(&version, bytes.data() + k_magic.size(), sizeof version);
    if (version != k_version)
        fail(path, fmt::format("has version {} of the format; this program reads version {}", version, k_version));

    const std::string content = decompress(path, std::string_view(bytes).substr(k_head_size));
    const auto state = std::make_shared<SavedState>();
    try {
        Reader reader(content);
        visit(reader, *state);
        if (!reader.at_end()) throw Error("it is longer than what it holds");
        check(*state);
    } catch (const Error& reason) {
        fail(path, std::string("is damaged: ") + reason.what());
    }
    return Snapshot(state);
}

void Snapshot::save(const fs::path& path) const {
    std::error_code error;
    if (const fs::file_status status = fs::symlink_status(path, error);
        fs::exists(status) && !fs::is_regular_file(status))
        fail(path, "cannot be written: there is something of that name which is not a file");
    Writer writer;
    visit(writer, *state_);

    const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> compressor(ZSTD_createCCtx(), &ZSTD_freeCCtx);
    ZSTD_CCtx_setParameter(compressor.get(), ZSTD_c_compressionLevel, k_compression_level);
    ZSTD_CCtx_setParameter(compressor.get(), ZSTD_c_checksumFlag, 1);
    std::string packed(ZSTD_compressBound(writer.content.size()), '\0');
    const std::size_t size =
        ZSTD_compress2(compressor.get(), packed.data(), packed.size(), writer.content.data(), writer.content.size());
    if (ZSTD_isError(size) != 0) fail(path, std::string("cannot be compressed: ") + ZSTD_getErrorName(size));

    fs::path temporary = path;
    temporary.replace_filename(fmt::format(".{}.{}.partial", path.filename().string(), getpid()));
    errno = 0;
    std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
    file.write(k_magic.data(), k_magic.size());
    file.write(reinterpret_cast<const char*>(&k_version), sizeof k_version);
    file.write(packed.data(), static_cast<std::streamsize>(size));
    file.close();
    const std::string reason = file ? "" : system_reason();
    if (file) fs::rename(temporary, path, error);
    if (reason.empty() && !error) return;
    std::error_code ignored;
    fs::remove(temporary, ignored);
    fail(path, "cannot be written: " + (reason.empty() ? error.message() : reason));
}

std::uint64_t Snapshot::step() const noexcept {
    return state_->report.step;
}
std::size_t Snapshot::body_count() const noexcept {
    return state_->table.body_count();
}
std::size_t Snapshot::bytes() const noexcept {
    return state_->bytes();
}

} // namespace talus
