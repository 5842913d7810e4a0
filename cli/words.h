// SPDX-License-Identifier: MIT
// The words for the engine's choices, the same on the command line, in reports and in state files.
#pragma once

#include <span>
#include <string_view>
#include <utility>

#include <talus/settings.h>

namespace talus::cli {

template <typename T> using Words = std::span<const std::pair<std::string_view, T>>;

Words<DeviceKind> device_words();
Words<BroadPhase> broad_phase_words();
Words<SolveOrder> solve_order_words();
Words<Stabilisation> stabilisation_words();
Words<BodyKind> body_kind_words();

template <typename T> std::string_view word_of(Words<T> words, T value) {
    for (const auto& [word, meaning] : words)
        if (meaning == value) return word;
    return "unknown";
}

} // namespace talus::cli
