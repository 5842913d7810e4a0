// SPDX-License-Identifier: MIT
// A barrier across all groups of a launch. OpenGL does not promise that groups which wait let others run, so a launch may
// have only as many as are known to run side by side: Device::resident_groups, which asks count_resident_groups here.
// Before this file the kernel declares Counters, and defines uint meeting_groups(): how many groups meet, the first ones
// of the launch. They may become fewer, behind a meeting of all that have met so far.

// 0: all groups that have arrived; 1: what was counted; the others are for kernels
layout(std430) coherent volatile buffer Arrivals { uint arrivals[]; };

uint expected = 0u; // to have arrived, in all meetings

// Some seconds: nobody waits for so long whose partners run at all.
const uint k_most_polls = 1u << 22;

bool have_arrived() { return int(arrivals[0] - expected) >= 0; }

const uint k_so_many = 0x40000000u;

bool have_given_up() { return arrivals[0] >= k_so_many; }

// Lets all go on, in this meeting and in all later ones. The host hears of it.
void give_up()
{
    atomicOr(arrivals[0], k_so_many);
    atomicOr(counters[k_counter_did_not_fit], k_fit_groups);
}

// What invocations have written to coherent buffers before it, all see behind it. In uniform control flow. arrivals[0] is 0 when
// the launch begins.
void wait_for_all_groups()
{
    expected += meeting_groups();
    memoryBarrierBuffer();
    barrier();
    if (gl_LocalInvocationID.x == 0u) {
        atomicAdd(arrivals[0], 1u);
        for (uint i = 0u; i < k_most_polls && !have_arrived(); ++i) {}
        if (!have_arrived()) give_up();
    }
    barrier();
    memoryBarrierBuffer(); // barrier() orders shared memory only
}

const uint k_patience_of_groups = 4096u; // polls; some milliseconds

shared uint polls_of_trial;

// Of a launch of more groups than can run at a time: into arrivals[1], how many had begun when the first of them had
// waited for long. All invocations stay until then, as in a launch that waits: some GPUs give the room of those that end
// to other groups.
void count_resident_groups()
{
    if (gl_LocalInvocationID.x == 0u) {
        atomicAdd(arrivals[0], 1u);
        uint polls = 0u;
        while (polls < k_patience_of_groups && arrivals[1] == 0u)
            ++polls;
        polls_of_trial = polls;
    }
    barrier();
    bool is_last = gl_LocalInvocationID.x == gl_WorkGroupSize.x - 1u;
    if (is_last && polls_of_trial == k_patience_of_groups) atomicCompSwap(arrivals[1], 0u, arrivals[0]);
}
