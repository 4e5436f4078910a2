// SPDX-License-Identifier: Apache-2.0
/** As languages write them that keep the Latin letters. */
export const UNITS = { mm: 'mm', um: 'µm', mm_min: 'mm/min', mm_s2: 'mm/s²', deg_min: '°/min', deg_s2: '°/s²' };
