// SPDX-License-Identifier: Apache-2.0
// The built page, byte for byte. STEADYREST_MOTION_BENCH_TEMPLATE is its path, given by CMake.
        .section .rodata
        .global steadyrest_motion_bench_template_begin
        .global steadyrest_motion_bench_template_end
steadyrest_motion_bench_template_begin:
        .incbin STEADYREST_MOTION_BENCH_TEMPLATE
steadyrest_motion_bench_template_end:
        .byte 0
        .section .note.GNU-stack, "", %progbits
