// SPDX-License-Identifier: MIT
// The buffers that the painter draws a world from: the world's own on a GPU, copies of its poses on the CPU device.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <talus/world.h>

#include "render/gl_names.h"
#include "render/overlay_lines.h"
#include "render/painter.h"
#include "state/buffers.h"

namespace talus::render {

class BodiesToDraw {
public:
    /// Brings the buffers up to date with the world and names them in the drawing. `more` is drawn with the overlays'
    /// lines.
    void update(const World&, const Overlays&, Drawing&, std::span<const Line> more = {});
    /// Edge length of the usual body that can move (m); of any body where none can; 1 in an empty world.
    float typical_size() const noexcept { return typical; }

private:
    void list_bodies(const World&);
    void update_bodies(const World&, Drawing&);

    std::vector<BodyId> bodies; // as they were listed
    bool listed = false;
    float typical = 1.0f;
    std::uint32_t slot_count = 0; // body slots up to the last that is in use
    std::uint32_t box_count = 0, sphere_count = 0;
    UploadBuffer slots, tints, contacts, lines;
    // Of a world without OpenGL.
    std::vector<engine::BodyPose> host_poses;
    UploadBuffer own_poses, own_shapes;
};

} // namespace talus::render
