// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <utility>

#include <steadyrest/adapters/opcua/words.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::adapters::opcua {
namespace {

struct Words {
  std::string_view why;
  std::string_view what;
  std::string_view to_do;
};

constexpr std::array<Words, 30> kWords = {{
    {"certificate_not_trusted", "the control's certificate is not trusted",
     "compare its fingerprint with the one on the control and trust it: steadyrest opcua trust"},
    {"certificate_changed", "the control shows another certificate than the trusted one",
     "find out why (new software, or another computer in its place) before you trust it: "
     "steadyrest opcua trust"},
    {"certificate_expired", "the control's certificate is not valid today",
     "set both clocks, or make a new certificate on the control"},
    {"certificate_other", "the fingerprint is not that of the control's certificate",
     "compare it again; another computer may answer at this address"},
    {"own_certificate_refused", "the control refuses the layer's certificate",
     "trust it on the control (docs/opcua.md, Certificates)"},
    {"own_certificate_not_made", "the layer's own certificate cannot be made",
     "let this user write the folder, or name another one: certificates in [opcua]"},
    {"certificates_not_written", "the folder of certificates cannot be written",
     "let this user write it, or name another one: certificates in [opcua]"},
    {"own_certificate_damaged", "the layer's own certificate or its key is damaged",
     "remove the folder own, and trust the new certificate on the control"},
    {"own_key_open", "others may read the private key of the layer's certificate", "chmod 600 it"},
    {"user_needed", "the control wants a user", "add user and password_file to [opcua]"},
    {"users_not_offered", "the control takes no user with a password at this endpoint",
     "allow users on the control, or leave user out"},
    {"user_refused", "the control refuses the user or the password",
     "create the user on the control, and put its password into password_file"},
    {"password_missing", "there is no password", "write it into password_file"},
    {"password_open", "others may read the password file", "chmod 600 it"},
    {"security_not_offered", "the control does not offer Basic256Sha256 with sign and encrypt",
     "switch it on in the control's OPC UA settings"},
    {"host_unknown", "the endpoint's host is not known",
     "correct endpoint, or give the control's IP address"},
    {"nobody_listens", "no OPC UA server listens there",
     "start it on the control, open its port in the firewall, or correct endpoint"},
    {"no_answer", "what listens there does not answer",
     "see whether the control's OPC UA server runs, or correct endpoint"},
    {"no_opcua", "what listens there speaks no OPC UA, or ends the connection",
     "correct endpoint (most controls: port 4840), and see whether the control lets this computer "
     "in"},
    {"no_way", "there is no way to the control", "see to the network cable and the IP addresses"},
    {"link_lost", "the link to the control is lost", "see to the network and the control"},
    {"too_many_sessions", "the control has no session left",
     "end other OPC UA clients; the licence limits their number"},
    {"namespace_unknown", "the control does not have the mapping's namespace",
     "use the mapping of this control and firmware"},
    {"node_malformed", "the mapping has a node that is none", "correct it in the mapping file"},
    {"not_connected", "there is no connection to the control",
     "wait; if it stays so, see the control's OPC UA log"},
    {"stopped", "the bridge was stopped", "start again"},
    {"bad_request", "the OPC UA bridge does not understand the layer",
     "use the bridge that belongs to this program"},
    {"bridge_ended", "the OPC UA bridge has ended",
     "it is started again; see whether Node runs: node --version"},
    {"bridge_hangs", "the OPC UA bridge does not answer",
     "it is started again; see what slows this computer down"},
    {"too_many_requests", "the OPC UA bridge is overloaded", "see what slows this computer down"},
}};

}  // namespace

kernel::outcome::Refusal refusal_of(std::string_view why, const std::string& detail,
                                    const kernel::machine::OpcUa& config) {
  const auto* const found = std::ranges::find(kWords, why, &Words::why);
  const bool known = found != kWords.end();
  std::string what = known ? std::string(found->what) : "the control cannot be reached";
  what += " (" + config.endpoint + (detail.empty() ? "" : ": " + detail) + ")";
  return kernel::outcome::unavailable(
             std::move(what), std::string(known ? found->to_do : "see the control's OPC UA log"))
      .error();
}

}  // namespace steadyrest::adapters::opcua
