// SPDX-License-Identifier: MIT
// The whole public API.
#pragma once

#include <talus/debug_draw.h>
#include <talus/log.h>
#include <talus/recording.h>
#include <talus/settings.h>
#include <talus/snapshot.h>
#include <talus/types.h>
#include <talus/version.h>
#include <talus/world.h>

/// @mainpage
/// All that Talus offers is in the namespace @ref talus, and begins with talus::World. The guide in docs/guide shows
/// how to use it.

/// All of the public interface.
namespace talus {}
