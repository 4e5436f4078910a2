// SPDX-License-Identifier: Apache-2.0
// The built page, byte for byte. STEADYREST_REPORT_TEMPLATE is its path, given by CMake.
        .section .rodata
        .global steadyrest_report_template_begin
        .global steadyrest_report_template_end
steadyrest_report_template_begin:
        .incbin STEADYREST_REPORT_TEMPLATE
steadyrest_report_template_end:
        .byte 0
        .section .note.GNU-stack, "", %progbits
