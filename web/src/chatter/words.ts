// SPDX-License-Identifier: Apache-2.0
// Words that the pages of the chatter verbs share.
import type { Term } from '../frame/view';

const NAMES: Record<string, string> = { hopf: 'Hopf', flip: 'flip' };

/** A type of chatter as people write it. */
export const typeName = (type: string) => NAMES[type] ?? type;

export const TYPES: Term = ['Hopf, flip', 'Hopf: the chatter frequency is unrelated to the tooth-passing frequency. Flip: it is an odd multiple of half of it; every second tooth cuts deeper.'];
