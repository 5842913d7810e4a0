// SPDX-License-Identifier: MIT
// A counter that is to be at least so large. Whoever has nothing larger only asks: atomic operations on one word wait for each other,
// and what is raised so does not fall meanwhile. Before this file the kernel declares Counters.

void raise_counter(uint counter, uint value)
{
    if (value > counters[counter]) atomicMax(counters[counter], value);
}
