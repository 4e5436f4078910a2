// SPDX-License-Identifier: Apache-2.0
import type { Role } from '../api/types';

const RANK: Record<Role, number> = { viewer: 0, operator: 1, engineer: 2 };

export function may(role: Role, needed: Role): boolean {
  return RANK[role] >= RANK[needed];
}
