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
