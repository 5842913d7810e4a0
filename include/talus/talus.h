// SPDX-License-Identifier: MIT
// The whole public API.
#pragma once

#include <talus/recording.h>
#include <talus/settings.h>
#include <talus/snapshot.h>
#include <talus/types.h>
#include <talus/world.h>
