// SPDX-License-Identifier: Apache-2.0
// The built page, byte for byte. STEADYREST_THERMAL_TEMPLATE is its path, given by CMake.
        .section .rodata
        .global steadyrest_thermal_template_begin
        .global steadyrest_thermal_template_end
steadyrest_thermal_template_begin:
        .incbin STEADYREST_THERMAL_TEMPLATE
steadyrest_thermal_template_end:
        .byte 0
        .section .note.GNU-stack, "", %progbits
