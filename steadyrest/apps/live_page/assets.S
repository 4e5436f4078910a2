// SPDX-License-Identifier: Apache-2.0
// The built live page and its description, byte for byte. The paths are given by CMake.
        .section .rodata
        .macro file name, path
        .global kSteadyrestLive\name\()Begin
        .global kSteadyrestLive\name\()End
kSteadyrestLive\name\()Begin:
        .incbin "\path"
kSteadyrestLive\name\()End:
        .byte 0
        .endm
        file Html, STEADYREST_LIVE_HTML
        file Script, STEADYREST_LIVE_SCRIPT
        file Style, STEADYREST_LIVE_STYLE
        file Openapi, STEADYREST_LIVE_OPENAPI
        .section .note.GNU-stack, "", %progbits
