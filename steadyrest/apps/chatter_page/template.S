// SPDX-License-Identifier: Apache-2.0
// The built page, byte for byte. STEADYREST_CHATTER_TEMPLATE is its path, given by CMake.
        .section .rodata
        .global steadyrest_chatter_template_begin
        .global steadyrest_chatter_template_end
steadyrest_chatter_template_begin:
        .incbin STEADYREST_CHATTER_TEMPLATE
steadyrest_chatter_template_end:
        .byte 0
        .section .note.GNU-stack, "", %progbits
