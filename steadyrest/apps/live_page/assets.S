// SPDX-License-Identifier: Apache-2.0
// The built live page and its description, byte for byte. The paths are given by CMake.
        .section .rodata
        .macro file name, path
        .global steadyrest_live_\name\()_begin
        .global steadyrest_live_\name\()_end
steadyrest_live_\name\()_begin:
        .incbin "\path"
steadyrest_live_\name\()_end:
        .byte 0
        .endm
        file html, STEADYREST_LIVE_HTML
        file script, STEADYREST_LIVE_SCRIPT
        file style, STEADYREST_LIVE_STYLE
        file openapi, STEADYREST_LIVE_OPENAPI
        .section .note.GNU-stack, "", %progbits
