// SPDX-License-Identifier: MIT
// Which bodies there are, and their shapes, changes only when bodies come or go: the lists are made again then.
#include "render/bodies_to_draw.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include <glm/vec4.hpp>

namespace talus::render {

namespace {

engine::BodyShape shape_record(const Shape& shape, BodyKind kind, bool sensor) {
    engine::BodyShape record;
    const std::uint32_t kind_bits = static_cast<std::uint32_t>(kind) << 8 | (sensor ? engine::k_sensor_bit : 0u);
    if (const auto* box = std::get_if<Box>(&shape)) {
        record.half_extents = {0.5f * box->size.x, 0.5f * box->size.y, 0.5f * box->size.z};
        record.type = engine::k_shape_box | kind_bits;
    } else {
        record.half_extents = glm::vec3(std::get<Sphere>(shape).radius);
        record.type = engine::k_shape_sphere | kind_bits;
    }
    return record;
}

float edge_length(const engine::BodyShape& shape) {
    return 2.0f * std::cbrt(shape.half_extents.x * shape.half_extents.y * shape.half_extents.z);
}

float median(std::vector<float>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

} // namespace

void BodiesToDraw::list_bodies(const World& world) {
    slot_count = 0;
    for (const BodyId id : bodies)
        slot_count = std::max(slot_count, id.index + 1);

    std::vector<std::uint32_t> boxes, spheres;
    std::vector<float> movable_lengths, lengths;
    std::vector<engine::BodyShape> shapes(slot_count);
    for (const BodyId id : bodies) {
        const BodyKind kind = world.kind(id);
        const engine::BodyShape shape = shape_record(world.shape(id), kind, world.is_sensor(id));
        shapes[id.index] = shape;
        ((shape.type & 0xffu) == engine::k_shape_sphere ? spheres : boxes).push_back(id.index);
        (kind == BodyKind::Static ? lengths : movable_lengths).push_back(edge_length(shape));
    }
    typical = !movable_lengths.empty() ? median(movable_lengths) : !lengths.empty() ? median(lengths) : 1.0f;
    box_count = static_cast<std::uint32_t>(boxes.size());
    sphere_count = static_cast<std::uint32_t>(spheres.size());
    boxes.insert(boxes.end(), spheres.begin(), spheres.end());
    slots.upload(boxes);
    if (world.device().kind == DeviceKind::Cpu) own_shapes.upload(shapes);
}

void BodiesToDraw::update_bodies(const World& world, Drawing& drawing) {
    std::vector<BodyId> present = world.bodies();
    if (!listed || present != bodies) {
        bodies = std::move(present);
        list_bodies(world);
        listed = true;
    }
    drawing.slots = slots;
    drawing.box_count = box_count;
    drawing.sphere_count = sphere_count;
    if (world.device().kind != DeviceKind::Cpu) {
        const GlBuffers buffers = world.gl_buffers();
        drawing.poses = buffers.poses;
        drawing.shapes = buffers.shapes;
        return;
    }
    const std::vector<Pose> poses = world.poses();
    host_poses.resize(slot_count);
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const Vec3& p = poses[i].position;
        const Quat& q = poses[i].rotation;
        host_poses[bodies[i].index] = {{p.x, p.y, p.z}, 0, {q.x, q.y, q.z, q.w}};
    }
    own_poses.upload(host_poses);
    drawing.poses = own_poses;
    drawing.shapes = own_shapes;
}

void BodiesToDraw::update(const World& world, const Overlays& overlays, Drawing& drawing, std::span<const Line> more) {
    update_bodies(world, drawing);
    drawing.aabbs = overlays.aabbs;
    drawing.wireframe = overlays.wireframe;
    drawing.transparent_static = overlays.transparent;

    std::vector<Contact> touching;
    if (overlays.contacts || overlays.normals || overlays.impulses || overlays.colours || overlays.islands)
        touching = world.contacts();
    if (overlays.pairs || overlays.islands) {
        tints.upload(tints_of(world, touching, overlays, slot_count));
        drawing.tints = tints;
    }
    if (overlays.contacts) {
        std::vector<glm::vec4> points;
        for (const Contact& contact : touching)
            for (const ContactPoint& point : contact.points)
                points.emplace_back(point.position.x, point.position.y, point.position.z, 0.0f);
        contacts.upload(points);
        drawing.contacts = contacts;
        drawing.contact_count = static_cast<std::uint32_t>(points.size());
    }
    std::vector<Line> all(more.begin(), more.end());
    if (overlays.normals || overlays.impulses || overlays.colours)
        add_contact_lines(all, world, touching, overlays, typical);
    if (overlays.velocities) add_velocity_lines(all, world, typical);
    if (all.empty()) return;
    lines.upload(all);
    drawing.lines = lines;
    drawing.line_count = static_cast<std::uint32_t>(all.size());
}

} // namespace talus::render
