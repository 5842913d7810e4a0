// SPDX-License-Identifier: MIT
// A barrier across all groups of a launch. OpenGL does not promise that groups which wait let others run, so a launch may
// have only as many as are known to run side by side: Device::resident_groups, which asks count_resident_groups here.

// 0: groups that have arrived; 1: what was counted
layout(std430) coherent volatile buffer Arrivals { uint arrivals[]; };

uint meetings = 0u;

// What invocations have written to coherent buffers before, those of all groups see afterwards. In uniform control flow.
// arrivals[0] is 0 when the launch begins.
void wait_for_all_groups()
{
    memoryBarrierBuffer();
    barrier();
    ++meetings;
    if (gl_LocalInvocationID.x == 0u) {
        atomicAdd(arrivals[0], 1u);
        while (arrivals[0] < meetings * gl_NumWorkGroups.x) {}
    }
    barrier(); // reads of coherent buffers that follow are of what is there now
}

const uint k_patience_of_groups = 4096u; // rounds; some milliseconds

// Of a launch of more groups than can run at a time: into arrivals[1], how many had begun when the first of them had
// waited for long.
void count_resident_groups()
{
    if (gl_LocalInvocationID.x != 0u) return;
    atomicAdd(arrivals[0], 1u);
    for (uint i = 0u; i < k_patience_of_groups; ++i) {
        if (arrivals[1] != 0u) return;
    }
    atomicCompSwap(arrivals[1], 0u, arrivals[0]);
}
