// SPDX-License-Identifier: MIT
// The benchmark for people: a line a case, printed as soon as the case is done.
#pragma once

#include <cstdio>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/bench_cases.h"
#include "bench/row.h"

namespace talus::bench {

class BenchTable {
public:
    BenchTable(std::FILE* out, const std::vector<Case>&, const BenchOptions&);

    void print_devices(const std::vector<DeviceInfo>&) const;
    void print_header() const;
    /// `rounds` are runs of the same case, at least one. `ratios` to a peer, one a round; empty for none.
    void print(std::span<const Row> rounds, std::span<const double> ratios = {}) const;

private:
    std::FILE* out;
    std::size_t scene_width;
    bool spread, ratio, stages;
};

/// Of at least one number.
double median_of(std::vector<double> numbers);

} // namespace talus::bench
