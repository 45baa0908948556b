// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Before a function: it is compiled twice, with all that it calls as far as the compiler knows it, and the program
/// takes what the processor can do when it starts. Where there is AVX2 loops treat twice as many numbers at once. Each
/// number comes from the same operations in the same order, so that results are the same bytes: AVX2 alone does not
/// fuse products with sums. Sanitizers are not ready yet when the choice is made.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define LINTEL_FOR_AVX2_TOO __attribute__((target_clones("avx2", "default"), flatten))
#else
#define LINTEL_FOR_AVX2_TOO
#endif
