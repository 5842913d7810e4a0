// SPDX-License-Identifier: MIT
// The host's record of all bodies: who is there, and a copy of what the device holds of them.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include <talus/types.h>

#include "state/buffers.h"
#include "step.h"

namespace talus::engine {

/// Which of a body's records the host has changed and the device does not know yet.
enum Dirty : std::uint8_t {
    k_dirty_pose = 1,
    k_dirty_velocity = 2,
    k_dirty_shape = 4,
    k_dirty_properties = 8,
    k_dirty_load = 16,
    k_dirty_all = 31,
    k_dirty_contacts =
        32, ///< none of the body's contacts may last: it stands, or is, otherwise than the last step has left it
};

struct MassProperties {
    float mass;   ///< kg
    Vec3 inertia; ///< kg·m², about the shape's own axes
};
/// What the definition gives, or its shape and density.
MassProperties mass_properties(const BodyDefinition&);

/// Whether it is a force, a torque or a reason to wake; zeros are none, whatever their sign.
bool acts(const BodyLoad&);

class BodyTable {
public:
    /// Room for as many bodies more at one go, of which some may take slots that are free, or will be. `threads`: that
    /// may help, here and below.
    void reserve(std::size_t more, uint threads = 1);
    /// A checked definition becomes a body, its rotation brought to unit length.
    BodyId add(const BodyDefinition&);
    /// The same of several, in their order.
    std::vector<BodyId> add(std::span<const BodyDefinition>, uint threads = 1);
    void remove(BodyId);
    bool contains(BodyId) const noexcept;

    /// Slots of removed bodies may be used again from now on. Called once the step after their removal has begun: until
    /// then the last step's manifolds still speak of them.
    void recycle();
    /// To be called once a step has begun: it uses up the loads that it was given.
    void forget_loads();
    /// Whether some load acts in the next step.
    bool has_loads() const;

    /// Up to the last slot in use.
    uint slot_count() const { return static_cast<uint>(poses.size()); }
    bool is_known(BodyId id) const { return id.index < next_generations.size(); }
    std::size_t body_count() const { return present_count; }
    bool is_present(uint slot) const { return uses[slot] == Use::Present; }
    BodyId id_of(uint slot) const { return {slot, generations[slot]}; }
    /// Also of a body that was removed, until its slot is used again.
    BodyId last_id_of(uint slot) const { return {slot, generations[slot]}; }
    BodyKind kind_of(uint slot) const { return static_cast<BodyKind>(shapes[slot].type >> 8 & 255u); }
    void set_sensor(uint slot, bool wanted);
    bool senses(uint slot) const { return (shapes[slot].type & k_sensor_bit) != 0; }

    /// Becomes a table of earlier, or another world's; all of it counts as changed. Ids that were given out since, and
    /// whose bodies are gone with it, stay invalid for ever.
    void restore(const BodyTable&);
    /// Whether the lists fit together, and what follows from them: for a table that was read from a file. Returns what
    /// is wrong; empty where nothing is.
    std::string complete();
    /// Calls `visit` with each list that makes up a table; what is not among them follows from them.
    template <typename Table, typename Visit> static void visit_lists(Table& table, const Visit& visit);

    void mark(uint slot, std::uint8_t what);
    /// The body, and what touches it, is to wake in the next step.
    void disturb(uint slot);
    /// What the bodies that were disturbed or removed since the last call ask for.
    Waking take_waking() { return std::exchange(waking, Waking::None); }
    void wake_all() { waking = Waking::All; }
    bool wakes_all() const { return waking == Waking::All; }
    /// What has been marked, with the records as they are now; the table then counts as known to the device.
    /// `with_loads`: whether that has room for them. Where it has none, no load may act.
    BodyChanges take_changes(bool with_loads, uint threads = 1);
    /// Whether the host has changed records of this kind that the device does not know yet.
    bool is_dirty(uint slot, std::uint8_t what) const { return (dirty[slot] & what) != 0; }
    /// The slots with changes that the device does not know yet, each once, in no order.
    const std::vector<uint>& changed_slots() const { return changed; }
    Population population() const { return {slot_count(), bouncing_count > 0, kinematic_count > 0}; }

    // The device's records, one a slot.
    std::vector<BodyPose> poses;
    std::vector<BodyVelocity> velocities;
    std::vector<BodyShape> shapes;
    std::vector<BodyProperties> properties;
    std::vector<BodyLoad> loads;
    // What only the host knows.
    std::vector<float> masses;  ///< kg; infinity where contacts cannot push the body
    std::vector<Vec3> inertias; ///< principal moments, kg·m²
    uint bouncing_count = 0;    ///< bodies with a restitution above 0
    uint kinematic_count = 0;

private:
    enum class Use : std::uint8_t { Free, Present, Resting };

    /// Calls `visit` with each list that has one element a slot.
    template <typename Visit> void for_each_slot_list(const Visit& visit);
    void note_change(uint slot, std::uint8_t what);
    /// A slot that a body has left; k_none where there is none.
    uint take_free_slot();
    void append_slots(std::size_t count, uint threads);
    void put(uint slot, const BodyDefinition&);
    /// Of the body in the slot: +1 where it has come, -1 where it is about to go.
    void count_body(uint slot, int sign);
    void drop_last_slot();

    // Both also of slots that were dropped, so that old ids stay invalid.
    std::vector<std::uint32_t> generations;      // of the body that is or was last in the slot
    std::vector<std::uint32_t> next_generations; // of the next body; also of slots that a restored table lacks
    std::vector<Use> uses;
    std::vector<std::uint8_t> dirty;
    std::vector<uint> changed;
    std::vector<uint> loaded; // slots with a load for the next step
    // A heap, lowest first, so that what a program gets does not depend on the order in which it removed. May also hold
    // slots that were dropped, or taken, since.
    std::vector<uint> free_slots;
    std::vector<uint> resting_slots;
    std::size_t present_count = 0;
    Waking waking = Waking::None;
};

template <typename Visit> void BodyTable::for_each_slot_list(const Visit& visit) {
    visit(poses);
    visit(velocities);
    visit(shapes);
    visit(properties);
    visit(loads);
    visit(masses);
    visit(inertias);
    visit(uses);
    visit(dirty);
}

template <typename Table, typename Visit> void BodyTable::visit_lists(Table& table, const Visit& visit) {
    visit(table.poses);
    visit(table.velocities);
    visit(table.shapes);
    visit(table.properties);
    visit(table.loads);
    visit(table.masses);
    visit(table.inertias);
    visit(table.generations);
    visit(table.next_generations);
    visit(table.uses);
    visit(table.free_slots);
    visit(table.resting_slots);
}

vec3 to_glm(Vec3);
vec4 to_glm(Quat);
Vec3 from_glm(vec3);
float length_of(Quat);
/// Where the caller has put a body, with the rotation brought to unit length.
BodyPose placed_at(const Pose&);
Pose from_record(const BodyPose&);
Velocity from_record(const BodyVelocity&);
uint pack_combine(const Material&);
Material unpack_material(const BodyProperties&);
Shape unpack_shape(const BodyShape&);

} // namespace talus::engine
