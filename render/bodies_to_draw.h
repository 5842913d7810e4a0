// SPDX-License-Identifier: MIT
// The buffers that the painter draws a world from: the world's own on a GPU, copies of its poses on the CPU device.
#pragma once

#include <cstdint>
#include <vector>

#include <talus/world.h>

#include "render/gl_names.h"
#include "render/painter.h"
#include "state/buffers.h"

namespace talus::render {

class BodiesToDraw {
public:
    /// Brings the buffers up to date with the world and names them in the drawing.
    void update(const World&, Drawing&);
    /// Marks the bodies that are in a candidate pair.
    void update_marks(const World&, Drawing&);
    void update_contacts(const World&, Drawing&);
    /// Edge length of the usual body that can move (m); of any body where none can; 1 in an empty world.
    float typical_size() const noexcept { return typical; }

private:
    void list_bodies(const World&);

    std::vector<BodyId> bodies; // as they were listed
    bool listed = false;
    float typical = 1.0f;
    std::uint32_t slot_count = 0; // body slots up to the last that is in use
    std::uint32_t box_count = 0, sphere_count = 0;
    UploadBuffer slots, marks, contacts;
    // Of a world without OpenGL.
    std::vector<engine::BodyPose> host_poses;
    UploadBuffer own_poses, own_shapes;
};

} // namespace talus::render
