// SPDX-License-Identifier: MIT
// One run of one scene, by Talus or by another engine.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "cli/report.h"

namespace talus::bench {

struct Row {
    std::string runs_on; ///< Talus's device, or the name of the other engine
    bool is_peer = false;
    cli::RunReport report; ///< of a peer: what is known of it

    double median_ms() const;
};

/// The keys of `run --report`. What a peer does not know is null.
nlohmann::ordered_json to_json(const Row&);

} // namespace talus::bench
