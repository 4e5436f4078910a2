// SPDX-License-Identifier: Apache-2.0

// As kernel/outcome/shown.cpp; the ends of lines stay.
const UNSEEN =
  /[\u0000-\u0008\u000b\u000c\u000e-\u001f\u007f-\u009f\u00ad\u034f\u061c\u115f\u1160\u180b-\u180f\u200b-\u200f\u2028-\u202e\u2060-\u206f\u3164\ufe00-\ufe0e\ufeff\uffa0\ufff9-\ufffb\u{1bca0}-\u{1bca3}\u{1d173}-\u{1d17a}\u{e0000}-\u{e0fff}]/gu;

function escaped(character: string): string {
  const code = character.codePointAt(0) ?? 0;
  const digits = (length: number): string => code.toString(16).padStart(length, '0');
  return code < 0x80 ? `\\x${digits(2)}` : code < 0x10000 ? `\\u${digits(4)}` : `\\U${digits(8)}`;
}

/** A text with names that others chose: what would not be seen, or would turn the direction of the rest, is escaped. */
export function shown(text: string): string {
  return text.replace(UNSEEN, escaped);
}
