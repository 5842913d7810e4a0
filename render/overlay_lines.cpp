// SPDX-License-Identifier: MIT
#include "render/overlay_lines.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <glm/geometric.hpp>

namespace talus::render {

namespace {

constexpr glm::vec3 k_pink{1.0f, 0.10f, 0.42f};
constexpr glm::vec3 k_yellow{1.0f, 0.62f, 0.02f};
constexpr glm::vec3 k_blue{0.02f, 0.16f, 0.95f};
constexpr glm::vec3 k_violet{0.42f, 0.05f, 0.75f};
constexpr glm::vec3 k_red{0.700f, 0.060f, 0.045f};
constexpr glm::vec3 k_grey{0.22f, 0.24f, 0.27f};
constexpr float k_velocity_time = 0.25f; // s

glm::vec3 to_glm(Vec3 v) {
    return {v.x, v.y, v.z};
}

/// Islands as the solver makes them: rigid bodies that contacts join. Each slot leads to the lowest of its island.
class Islands {
public:
    Islands(const World& world, std::span<const Contact> contacts, std::uint32_t slot_count) : leads_to(slot_count) {
        std::iota(leads_to.begin(), leads_to.end(), 0u);
        for (const Contact& contact : contacts) {
            if (contact.sensor) continue;
            if (world.kind(contact.a) != BodyKind::Rigid || world.kind(contact.b) != BodyKind::Rigid) continue;
            const std::uint32_t a = leader(contact.a.index), b = leader(contact.b.index);
            leads_to[std::max(a, b)] = std::min(a, b);
        }
    }

    std::uint32_t leader(std::uint32_t slot) {
        while (leads_to[slot] != slot)
            slot = leads_to[slot] = leads_to[leads_to[slot]];
        return slot;
    }

private:
    std::vector<std::uint32_t> leads_to;
};

} // namespace

std::uint32_t pack_colour(glm::vec3 colour, float opacity) {
    const auto byte = [](float value) {
        return static_cast<std::uint32_t>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
    };
    return byte(colour.x) | byte(colour.y) << 8 | byte(colour.z) << 16 | byte(opacity) << 24;
}

glm::vec3 colour_of_number(std::uint32_t number) {
    // Hues a golden section apart; every third is darker.
    const float hue = std::fmod(0.05f + 0.61803399f * static_cast<float>(number % 4096u), 1.0f);
    const float brightness = number % 3 == 2 ? 0.4f : 0.9f;
    const auto channel = [&](float shift) {
        return brightness * std::clamp(std::abs(std::fmod(6.0f * hue + shift, 6.0f) - 3.0f) - 1.0f, 0.02f, 1.0f);
    };
    return {channel(0.0f), channel(4.0f), channel(2.0f)};
}

void add_arrow(std::vector<Line>& lines, glm::vec3 from, glm::vec3 to, std::uint32_t colour) {
    const glm::vec3 way = to - from;
    const float length = glm::length(way);
    if (!(length > 0.0f)) return;
    lines.push_back({from, colour, to, 2.0f});
    const glm::vec3 other = std::abs(way.y) < 0.9f * length ? glm::vec3(0.0f, 1.0f, 0.0f) : glm::vec3(1.0f, 0.0f, 0.0f);
    const glm::vec3 across = glm::normalize(glm::cross(way, other)), third = glm::cross(across, way / length);
    for (const glm::vec3 side : {across, -across, third, -third})
        lines.push_back({to, colour, to - 0.25f * way + 0.1f * length * side, 2.0f});
}

void add_contact_lines(std::vector<Line>& lines, const World& world, std::span<const Contact> contacts,
                       const Overlays& overlays, float typical_size) {
    float largest = 0.0f;
    for (const Contact& contact : contacts)
        for (const ContactPoint& point : contact.points)
            largest = std::max(largest, point.normal_impulse);
    for (const Contact& contact : contacts) {
        const glm::vec3 normal = to_glm(contact.normal);
        glm::vec3 middle(0.0f);
        for (const ContactPoint& point : contact.points) {
            const glm::vec3 place = to_glm(point.position);
            middle += place / static_cast<float>(contact.points.size());
            if (overlays.normals)
                lines.push_back({place, pack_colour(k_pink), place + 0.35f * typical_size * normal, 2.0f});
            if (overlays.impulses && point.normal_impulse > 0.0f)
                add_arrow(lines, place, place + 2.0f * typical_size * (point.normal_impulse / largest) * normal,
                          pack_colour(k_yellow));
        }
        if (!overlays.colours || contact.sensor) continue;
        const std::uint32_t colour = pack_colour(colour_of_number(contact.colour));
        for (const BodyId id : {contact.a, contact.b})
            if (world.kind(id) != BodyKind::Static)
                lines.push_back({middle, colour, to_glm(world.pose(id).position), 2.5f});
    }
}

void add_velocity_lines(std::vector<Line>& lines, const World& world, float typical_size) {
    const std::vector<Pose> poses = world.poses();
    const std::vector<Velocity> velocities = world.velocities();
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const glm::vec3 centre = to_glm(poses[i].position);
        add_arrow(lines, centre, centre + k_velocity_time * to_glm(velocities[i].linear), pack_colour(k_blue));
        const glm::vec3 spin = k_velocity_time * typical_size * to_glm(velocities[i].angular);
        if (glm::length(spin) > 0.02f * typical_size)
            lines.push_back({centre - spin, pack_colour(k_violet), centre + spin, 1.5f});
    }
}

std::vector<std::uint32_t> tints_of(const World& world, std::span<const Contact> contacts, const Overlays& overlays,
                                    std::uint32_t slot_count) {
    std::vector<std::uint32_t> tints(slot_count, 0);
    if (overlays.islands) {
        Islands islands(world, contacts, slot_count);
        std::vector<std::uint32_t> sizes(slot_count, 0);
        const std::vector<BodyId> bodies = world.bodies();
        for (const BodyId id : bodies)
            ++sizes[islands.leader(id.index)];
        for (const BodyId id : bodies)
            if (const std::uint32_t leader = islands.leader(id.index); sizes[leader] > 1)
                tints[id.index] = pack_colour(0.6f * colour_of_number(leader));
        for (const BodyId id : bodies)
            if (world.is_asleep(id)) tints[id.index] = pack_colour(k_grey);
    }
    if (overlays.pairs) {
        for (const CollisionPair& pair : world.collision_pairs())
            for (const BodyId id : {pair.a, pair.b})
                // Nearly every scene's ground is in some pair: in red it would tell nothing.
                if (world.kind(id) != BodyKind::Static) tints[id.index] = pack_colour(k_red);
    }
    return tints;
}

} // namespace talus::render
