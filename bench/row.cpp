// SPDX-License-Identifier: MIT
// A peer has no stages, colours or buffers that Talus could see: such keys are null, never 0.
#include "bench/row.h"

namespace talus::bench {

double Row::median_ms() const {
    return cli::statistics_of(report.timing.step_ms).median;
}

nlohmann::ordered_json to_json(const Row& row) {
    nlohmann::ordered_json json = cli::to_json(row.report);
    if (!row.is_peer) return json;
    json["device"]["kind"] = row.runs_on;
    for (const char* key :
         {"substeps", "stabilisation", "solve_order", "broad_phase", "colours", "growths", "state_hash"})
        json[key] = nullptr;
    json["memory_bytes"] = {{"device", nullptr}, {"host", nullptr}};
    return json;
}

} // namespace talus::bench
