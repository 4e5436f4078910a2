// SPDX-License-Identifier: Apache-2.0
// The built page, byte for byte. STEADYREST_PAGE is its path, given by CMake.
        .section .rodata
        .global steadyrest_page_begin
        .global steadyrest_page_end
steadyrest_page_begin:
        .incbin STEADYREST_PAGE
steadyrest_page_end:
        .byte 0
        .section .note.GNU-stack, "", %progbits
