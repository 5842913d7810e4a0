// SPDX-License-Identifier: MIT
// Floating-point mode of the CPU device: GPUs take numbers too small for a normalised float for zero, and the CPU does
// as they do. It also keeps a world that comes to rest fast, as arithmetic on such numbers is slow on many CPUs. Mesa's
// llvmpipe is the exception: it computes with them.
#pragma once

#if defined(__x86_64__) || defined(__i386__)
#include <xmmintrin.h>
#elif defined(__aarch64__)
#include <cstdint>
#endif

namespace talus::engine {

/// While it lives, denormal numbers are zero on this thread; then the caller's mode comes back.
class FlushDenormals {
public:
    FlushDenormals() : before(mode()) { set_mode(before | k_flush); }
    ~FlushDenormals() { set_mode(before); }
    FlushDenormals(const FlushDenormals&) = delete;
    FlushDenormals& operator=(const FlushDenormals&) = delete;

private:
#if defined(__x86_64__) || defined(__i386__)
    using Mode = unsigned;
    static constexpr Mode k_flush = 0x8040; // MXCSR: flush to zero (bit 15), denormals are zero (bit 6)
    static Mode mode() {
        return _mm_getcsr();
    }
    static void set_mode(Mode mode) {
        _mm_setcsr(mode);
    }
#elif defined(__aarch64__)
    using Mode = std::uint64_t;
    static constexpr Mode k_flush = Mode{1} << 24; // FPCR: FZ
    static Mode mode() {
        Mode mode;
        asm volatile("mrs %0, fpcr" : "=r"(mode));
        return mode;
    }
    static void set_mode(Mode mode) {
        asm volatile("msr fpcr, %0" : : "r"(mode));
    }
#else
    using Mode = unsigned;
    static constexpr Mode k_flush = 0;
    static Mode mode() {
        return 0;
    }
    static void set_mode(Mode) {}
#endif

    Mode before;
};

} // namespace talus::engine
