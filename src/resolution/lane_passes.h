// SPDX-License-Identifier: MIT
// The solver's passes over several items side by side: a body or a contact constraint in each lane of the CPU's vector
// registers. With the same bits as body_passes.h and contact_passes.h, which go through them one by one.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "device/cpu/instruction_set.h"
#include "resolution/contact_passes.h"

namespace talus::engine {

/// A manifold whose constraint is to be made.
struct ContactToPrepare {
    uint index; ///< the constraint's
    uint manifold;
    uint colour;
    uint order;      ///< see contact_counts.shared.glsl
    float hub_share; ///< 1 but in the colours of hubs
};

/// What passes need of some items is kept from the first pass of a step to the last in a batch, which has one in each
/// lane. A pass has a bit set in its result for each that it has left alone: what is rare, as hits, is for the
/// functions that treat one item.
struct LanePasses {
    uint lanes; ///< items side by side
    /// Writes the constraints of at most `lanes` manifolds, and tells their loads.
    void (*prepare_contacts)(const CpuState&, const ContactToPrepare*, uint count);

    std::size_t constraint_batch_bytes;
    /// Of constraints that are prepared. No two may share a body that can be pushed, but a hub.
    void (*take_constraints)(const CpuState&, const uint* indices, uint count, void* batch);
    /// See pass_over_constraint.
    uint (*pass_over_constraints)(const CpuState&, ContactPass, uint tick, void* batch);

    std::size_t body_batch_bytes;
    void (*take_bodies)(const CpuState&, const uint* indices, uint count, void* batch);
    /// See integrate_body.
    uint (*integrate_bodies)(const CpuState&, uint tick, void* batch);
};

/// For the widest registers that this machine has.
const LanePasses& lane_passes();

/// See load_below.
void tell_load(const CpuState&, const LoadBelow&, uint height);
void tell_foot(const CpuState&, const ToldFoot&);

/// Items in batches, as many in each as there are lanes.
class Batches {
public:
    /// For the items `indices`, each batch of which is to be taken before it is passed over.
    void assign(std::span<const uint> indices, std::size_t batch_bytes);
    uint count() const { return static_cast<uint>(indices_.size() + lane_passes().lanes - 1) / lane_passes().lanes; }
    std::size_t memory_bytes() const { return line_count_ * sizeof(Line) + indices_.capacity() * sizeof(uint); }

protected:
    const uint* indices_of(uint batch) const { return &indices_[batch * lane_passes().lanes]; }
    uint size_of(uint batch) const;
    void* memory_of(uint batch) { return &lines_[batch * lines_a_batch_]; }

private:
    struct alignas(64) Line {
        std::byte bytes[64];
    };

    std::vector<uint> indices_;
    std::unique_ptr<Line[]> lines_;
    std::size_t line_count_ = 0, lines_a_batch_ = 0;
};

/// Constraints of one colour.
class ConstraintBatches : public Batches {
public:
    void assign(std::span<const uint> indices) { Batches::assign(indices, lane_passes().constraint_batch_bytes); }
    void take(const CpuState&, uint batch);
    void pass_over(CpuState&, ContactPass, uint tick, uint batch);
};

class BodyBatches : public Batches {
public:
    void assign(std::span<const uint> indices) { Batches::assign(indices, lane_passes().body_batch_bytes); }
    void take(const CpuState&, uint batch);
    void integrate(CpuState&, uint tick, uint batch);
};

} // namespace talus::engine
