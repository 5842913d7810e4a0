// SPDX-License-Identifier: MIT
// Scan and sort on both devices against the standard library, for sizes around those of groups and tiles.
#include <algorithm>
#include <map>
#include <numeric>
#include <random>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "primitives/kernels.h"
#include "primitives/primitives.h"

namespace talus::engine {
namespace {

using Words = std::vector<uint>;

const uint k_sizes[] = {0, 1, 63, 64, 65, 255, 256, 257, 1023, 1024, 1025, 2047, 2048, 2049, 4095, 10'000, 100'000};

constexpr uint k_count = k_counter_pair_count;
constexpr uint k_total = k_counter_pair_demand;
constexpr uint k_untouched = 0xabcdef01u;

/// One device of a kind for all tests; null, with the reason, where there is none here.
struct Candidate {
    std::unique_ptr<Device> device;
    std::string why_not;
};

std::map<DeviceKind, Candidate> candidates;

/// Some drivers are gone before the program's variables are.
class Candidates : public testing::Environment {
    void TearDown() override { candidates.clear(); }
};
[[maybe_unused]] const testing::Environment* const environment = testing::AddGlobalTestEnvironment(new Candidates);

Candidate& candidate(DeviceKind kind) {
    const auto [entry, is_new] = candidates.try_emplace(kind);
    if (is_new) {
        try {
            entry->second.device =
                kind == DeviceKind::Cpu ? make_cpu_device(3, false) : make_gl_device(GlContext::Own, false);
        } catch (const Error& error) {
            entry->second.why_not = error.what();
        }
    }
    return entry->second;
}

class Primitives : public testing::TestWithParam<DeviceKind> {
protected:
    void SetUp() override {
        const Candidate& found = candidate(GetParam());
        if (!found.device) GTEST_SKIP() << "NOT TESTED, there is no such device here: " << found.why_not;
        device = found.device.get();
    }
    Device* device = nullptr;
};

void upload(Device& device, BufferId buffer, const Words& words) {
    device.grow(buffer, std::max<std::size_t>(1, words.size()) * sizeof(uint));
    device.write(buffer, 0, std::as_bytes(std::span(words)));
}

Words download(Device& device, BufferId buffer, std::size_t count) {
    Words words(count);
    const ReadRequest request{buffer, count * sizeof(uint), words.data()};
    device.read({&request, 1});
    return words;
}

void set_counters(Device& device, uint count) {
    Words counters(k_counter_words, k_untouched);
    counters[k_count] = count;
    upload(device, BufferId::Counters, counters);
}

void set_dispatch(Device& device, uint slot, uint groups, uint items) {
    device.grow(BufferId::Dispatches, k_dispatch_count * sizeof(Dispatch));
    const Dispatch dispatch{groups, 1, 1, items};
    device.write(BufferId::Dispatches, slot * sizeof(Dispatch), std::as_bytes(std::span(&dispatch, 1)));
}

Words random_words(uint count, uint below, uint seed) {
    std::mt19937 random(seed);
    Words words(count);
    for (uint& word : words)
        word = below == 0 ? random() : random() % below;
    return words;
}

struct Scanned {
    Words values;
    uint total;
    friend bool operator==(const Scanned&, const Scanned&) = default;
};

/// Scans on the device; behind the values lie words up to the capacity and one more, which come back too.
Scanned scan(Device& device, const Words& values, uint capacity) {
    const uint count = static_cast<uint>(values.size());
    Words padded = values;
    padded.resize(capacity + 1, k_untouched);
    upload(device, BufferId::PairCounts, padded);
    set_counters(device, count);
    exclusive_scan(device, BufferId::PairCounts, capacity, k_count, k_total);
    return {download(device, BufferId::PairCounts, padded.size()),
            download(device, BufferId::Counters, k_counter_words)[k_total]};
}

Scanned expected_scan(const Words& values, uint capacity) {
    Words scanned(capacity + 1, k_untouched);
    std::exclusive_scan(values.begin(), values.end(), scanned.begin(), 0u);
    return {scanned, std::accumulate(values.begin(), values.end(), 0u)};
}

struct Sorted {
    Words keys;
    Words values;
    friend bool operator==(const Sorted&, const Sorted&) = default;
};

/// Sorts on the device, with the numbers 0, 1, … as values.
Sorted sort(Device& device, const Words& keys, uint capacity, uint bits, uint slot = k_none) {
    const uint count = static_cast<uint>(keys.size());
    Words values(count);
    std::iota(values.begin(), values.end(), 0u);
    const engine::Sort wanted{.keys = BufferId::SortKeys,
                              .values = BufferId::SortValues,
                              .capacity = capacity,
                              .count_counter = k_count,
                              .bits = bits,
                              .slot = slot};
    // Of another length than the scratch: who reads there reads something else.
    upload(device, BufferId::SortKeys, Words(capacity + 1, k_untouched));
    upload(device, BufferId::SortValues, Words(capacity + 1, k_untouched));
    const auto [unsorted_keys, unsorted_values] = unsorted_place(device, wanted);
    upload(device, unsorted_keys, keys);
    upload(device, unsorted_values, values);
    set_counters(device, count);
    if (slot != k_none) set_dispatch(device, slot, divide_up(count, k_sort_tile), count);
    sort_by_key(device, wanted);
    return {download(device, BufferId::SortKeys, count), download(device, BufferId::SortValues, count)};
}

Sorted expected_sort(const Words& keys) {
    Sorted sorted{keys, Words(keys.size())};
    std::iota(sorted.values.begin(), sorted.values.end(), 0u);
    std::stable_sort(sorted.values.begin(), sorted.values.end(), [&](uint a, uint b) { return keys[a] < keys[b]; });
    std::sort(sorted.keys.begin(), sorted.keys.end());
    return sorted;
}

// Sequences of 100,000 words are no help in a message, so equality is asserted as a truth.

TEST_P(Primitives, scan_equals_the_standard_library) {
    for (const uint count : k_sizes) {
        SCOPED_TRACE(count);
        for (const uint below : {100u, 0u}) { // sums of whole words wrap around
            const Words values = random_words(count, below, count);
            ASSERT_TRUE(scan(*device, values, count) == expected_scan(values, count));
        }
    }
}

TEST_P(Primitives, scan_does_not_depend_on_the_capacity) {
    for (const uint capacity : {1'000u, 8'192u, 8'193u, 50'000u}) {
        for (const uint count : {0u, 1u, 999u, 1'000u}) {
            SCOPED_TRACE(testing::Message() << count << " of " << capacity);
            const Words values = random_words(count, 10, count);
            ASSERT_TRUE(scan(*device, values, capacity) == expected_scan(values, capacity));
        }
    }
}

TEST_P(Primitives, sort_equals_a_stable_sort) {
    for (const uint count : k_sizes) {
        SCOPED_TRACE(count);
        const Words keys = random_words(count, 0, count);
        ASSERT_TRUE(sort(*device, keys, count, 32) == expected_sort(keys));
    }
}

TEST_P(Primitives, sort_keeps_the_order_of_equal_keys) {
    for (const uint count : k_sizes) {
        SCOPED_TRACE(count);
        for (const Words& keys : {random_words(count, 5, count), Words(count, 77)})
            ASSERT_TRUE(sort(*device, keys, count, 8) == expected_sort(keys));
    }
}

TEST_P(Primitives, both_ways_to_sort_give_the_same) {
    constexpr uint limit = k_sort_in_group_keys;
    for (const uint count : {0u, 1u, 2u, 3u, 31u, 33u, 511u, 512u, 513u, 1'025u, limit - 1, limit}) {
        for (const uint below : {0u, 1u, 2u, 50u}) {
            SCOPED_TRACE(testing::Message() << count << " keys below " << below);
            const Words keys = random_words(count, below, count + below);
            const Sorted in_group = sort(*device, keys, limit, 32);
            ASSERT_TRUE(in_group == sort(*device, keys, limit + 1, 32));
            ASSERT_TRUE(in_group == expected_sort(keys));
        }
    }
}

TEST_P(Primitives, keys_of_all_bits_stay_within_the_count) {
    for (const uint count : {1u, 3u, 1'025u, 3'000u}) {
        SCOPED_TRACE(count);
        Words keys(count, 0xffffffffu);
        keys.back() = 0;
        ASSERT_TRUE(sort(*device, keys, count, 32) == expected_sort(keys));
    }
}

TEST_P(Primitives, a_sort_of_nothing_leaves_the_last_result_alone) {
    for (const uint bits : {8u, 16u, 20u}) {
        SCOPED_TRACE(bits);
        const engine::Sort wanted{.keys = BufferId::SortKeys,
                                  .values = BufferId::SortValues,
                                  .capacity = 3'000,
                                  .count_counter = k_count,
                                  .bits = bits};
        const Words keys(wanted.capacity, k_untouched), values(wanted.capacity, k_untouched - 1);
        upload(*device, BufferId::SortKeys, keys);
        upload(*device, BufferId::SortValues, values);
        const auto unsorted = unsorted_place(*device, wanted), spare = spare_place(*device, wanted);
        EXPECT_NE(unsorted.keys, spare.keys);
        EXPECT_NE(unsorted.values, spare.values);
        EXPECT_EQ(unsorted.keys == BufferId::SortKeys, bits == 16) << "the number of passes is even";
        set_counters(*device, 0);
        sort_by_key(*device, wanted);
        EXPECT_TRUE(download(*device, BufferId::SortKeys, keys.size()) == keys);
        EXPECT_TRUE(download(*device, BufferId::SortValues, values.size()) == values);
    }
}

TEST_P(Primitives, sort_takes_as_many_passes_as_the_bits_need) {
    for (const uint bits : {1u, 8u, 9u, 16u, 20u, 24u}) {
        SCOPED_TRACE(bits);
        const Words keys = random_words(3'000, 1u << bits, bits);
        ASSERT_TRUE(sort(*device, keys, 3'000, bits) == expected_sort(keys));
    }
}

/// Up to 256 tiles groups add up the counts of all themselves, and beyond there is a scan.
TEST_P(Primitives, sort_does_not_depend_on_the_capacity) {
    for (const uint capacity : {40'000u, 256 * k_sort_tile, 256 * k_sort_tile + 1}) {
        for (const uint count : {0u, 1u, 1'000u, 5'000u, 40'000u}) {
            SCOPED_TRACE(testing::Message() << count << " keys in room for " << capacity);
            const Words keys = random_words(count, 0, count);
            ASSERT_TRUE(sort(*device, keys, capacity, 32) == expected_sort(keys));
        }
    }
}

TEST_P(Primitives, sort_of_many_tiles_equals_a_stable_sort) {
    for (const uint count : {256 * k_sort_tile, 256 * k_sort_tile + 1, 300'000u}) {
        SCOPED_TRACE(count);
        const Words keys = random_words(count, 1u << 16, count);
        ASSERT_TRUE(sort(*device, keys, count, 16) == expected_sort(keys));
    }
}

TEST_P(Primitives, sort_takes_its_groups_from_a_dispatch) {
    for (const uint count : {0u, 1u, 1'024u, 1'025u, 10'000u}) {
        SCOPED_TRACE(count);
        const Words keys = random_words(count, 0, count);
        ASSERT_TRUE(sort(*device, keys, 40'000, 32, k_dispatch_graph_tiles) == expected_sort(keys));
    }
}

TEST_P(Primitives, any_words_are_scanned) {
    ASSERT_TRUE(rc::check([this](const Words& values) {
        const uint count = static_cast<uint>(values.size());
        RC_ASSERT(scan(*device, values, count) == expected_scan(values, count));
    }));
}

TEST_P(Primitives, any_keys_are_sorted) {
    ASSERT_TRUE(rc::check([this](const Words& keys) {
        RC_ASSERT(sort(*device, keys, static_cast<uint>(keys.size()), 32) == expected_sort(keys));
    }));
}

/// In one group, and in an odd and an even number of passes; of nothing, places of before stay.
TEST_P(Primitives, places_are_the_inverse_of_the_order) {
    for (const uint capacity : {2'048u, 40'000u}) {
        for (const uint bits : {8u, 16u, 20u}) {
            for (const uint count : {0u, 1u, 1'025u, 2'048u, capacity}) {
                SCOPED_TRACE(testing::Message() << count << " keys of " << bits << " bits in room for " << capacity);
                const Words keys = random_words(count, 1u << bits, count + bits);
                const engine::Sort wanted{.keys = BufferId::SortKeys,
                                          .values = BufferId::SortValues,
                                          .capacity = capacity,
                                          .count_counter = k_count,
                                          .bits = bits,
                                          .gives_places = true};
                upload(*device, BufferId::SortKeys, Words(capacity, k_untouched));
                upload(*device, BufferId::SortValues, Words(capacity, k_untouched));
                const auto [unsorted_keys, unsorted_values] = unsorted_place(*device, wanted);
                upload(*device, unsorted_keys, keys);
                if (unsorted_values != BufferId::SortValues)
                    upload(*device, unsorted_values, Words(count, k_untouched));
                set_counters(*device, count);
                sort_by_key(*device, wanted);
                const Sorted sorted = expected_sort(keys);
                Words places(capacity, k_untouched);
                for (uint place = 0; place < count; ++place)
                    places[sorted.values[place]] = place;
                ASSERT_TRUE(download(*device, BufferId::SortKeys, count) == sorted.keys);
                ASSERT_TRUE(download(*device, BufferId::SortValues, capacity) == places);
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Devices, Primitives, testing::Values(DeviceKind::Cpu, DeviceKind::Gpu),
                         [](const auto& test) { return test.param == DeviceKind::Cpu ? "cpu" : "gl"; });

} // namespace
} // namespace talus::engine
