// SPDX-License-Identifier: Apache-2.0
// Why the control is out of reach, as one stable word and a sentence. The layer turns the word into
// what to do.

/** Fault with a stable word. */
export class Fault extends Error {
  constructor(why, detail) {
    super(detail);
    this.why = why;
  }
}

const kByStatus = [
  [/ANONYMOUS.*user token policy/i, "user_needed"],
  [/user token policy/i, "users_not_offered"],
  [/BadIdentityTokenRejected|BadIdentityTokenInvalid|BadUserAccessDenied/, "user_refused"],
  [/BadUserSignatureInvalid/, "user_refused"],
  [/BadTooManySessions|BadMaxConnectionsReached|BadTcpNotEnoughResources/, "too_many_sessions"],
  [/BadCertificate|BadSecurityChecksFailed|BadApplicationSignatureInvalid|BadNonceInvalid/, "own_certificate_refused"],
  [/BadSecurityPolicyRejected|BadSecurityModeRejected|security mode|security policy/i, "security_not_offered"],
  [/ENOTFOUND|EAI_AGAIN/, "host_unknown"],
  [/ECONNREFUSED|cannot be established/, "nobody_listens"],
  [/EHOSTUNREACH|ENETUNREACH|ETIMEDOUT/, "no_way"],
  [/rejected by server[^]*Timeout/, "no_answer"],
  [/rejected by server/, "no_opcua"],
  [/timeout|BadTimeout|BadRequestTimeout|BadConnectionClosed|Connection Break|ECONNRESET|EPIPE|socket/i, "link_lost"],
];

/** @param {unknown} error */
export function whyOf(error) {
  if (error instanceof Fault) return error.why;
  const text = error instanceof Error ? error.message : String(error);
  for (const [pattern, why] of kByStatus) {
    if (pattern.test(text)) return why;
  }
  return "failed";
}

/** @param {unknown} error */
export function textOf(error) {
  const text = error instanceof Error ? error.message : String(error);
  // node-opcua puts the cause behind two lines of advice.
  const first = (/Err = \(([^]*)\)/.exec(text)?.[1] ?? text.split("\n")[0]).trim();
  return (first === "" && error instanceof Error ? error.name : first).slice(0, 400);
}
