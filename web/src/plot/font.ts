// SPDX-License-Identifier: Apache-2.0
export const FONT = 'system-ui, "Segoe UI", "Noto Sans", "DejaVu Sans", sans-serif';
