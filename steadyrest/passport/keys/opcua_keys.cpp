// SPDX-License-Identifier: Apache-2.0
#include <array>

#include <steadyrest/passport/keys/choice.hpp>
#include <steadyrest/passport/keys/schema.hpp>

// Keys of the port `opcua` and of a mapping file.
namespace steadyrest::passport {
namespace {

using kernel::machine::OpcUa;
using std::string_view;

constexpr std::array<string_view, 2> kSecurities = {"sign_and_encrypt", "none"};
constexpr double kMostR = 32535;  ///< MM_NUM_R_PARAM at most

}  // namespace

std::span<const Key<OpcUa>> opcua_keys() noexcept {
  static const std::array kKeys = {
      Key<OpcUa>{"endpoint", &OpcUa::endpoint, 1, 255,
                 "Address of the control's OPC UA server: `opc.tcp://HOST:PORT`.", Need::mandatory},
      Key<OpcUa>{"mapping", &OpcUa::mapping, 1, 1024,
                 "File that maps the control's nodes, from this file's folder on; "
                 "`examples/opcua/` has some.",
                 Need::mandatory},
      Key<OpcUa>{"security", choice<OpcUa, &OpcUa::security>(kSecurities), 0, 0,
                 "Basic256Sha256 with signature and encryption, or nothing: then everybody in the "
                 "network can read and change what is sent."},
      Key<OpcUa>{"user", &OpcUa::user, 1, 128, "User on the control; without it: anonymous."},
      Key<OpcUa>{"password_file", &OpcUa::password_file, 1, 1024,
                 "File with the password, readable by its owner alone (mode 600)."},
      Key<OpcUa>{"password_variable", &OpcUa::password_variable, 1, 128,
                 "Environment variable with the password, instead of a file."},
      Key<OpcUa>{"certificates", &OpcUa::certificates, 1, 1024,
                 "Folder of the layer's certificate and of the trusted controls; by default "
                 "`steadyrest/opcua` in the user's state folder."},
      Key<OpcUa>{"cycle_ms", &OpcUa::cycle_s, 5, 1000, "The layer reads and writes this often."},
      Key<OpcUa>{"reply_ms", &OpcUa::reply_s, 10, 10000, "Longest wait for the control's answer."},
      Key<OpcUa>{"channel", &OpcUa::channel, 1, 10, "Channel of the control."},
      Key<OpcUa>{"sample_r", &OpcUa::first_sample, 0, kMostR,
                 "First of the R parameters in which the control's side shows its sample."},
      Key<OpcUa>{"order_r", &OpcUa::first_order, 0, kMostR,
                 "First of the R parameters that the layer writes."},
      Key<OpcUa>{"work_r", &OpcUa::first_work, 0, kMostR,
                 "First of the R parameters that the control's side works with."},
      Key<OpcUa>{"first_action", &OpcUa::first_action, 1, 200,
                 "Number of the first synchronized action of the control's side."},
      Key<OpcUa>{"dead_man_ms", &OpcUa::dead_man_s, 20, 10000,
                 "Without a new order the control's side keeps feed and spindle for this long, "
                 "then hands back by itself. Longer than a computer or network is ever late."},
      Key<OpcUa>{"hand_back_percent_s", &OpcUa::hand_back_1_s, 10, 1000,
                 "Rise of the feed in the control's side, at most."},
      Key<OpcUa>{"spindle", &OpcUa::spindle, 1, 16, "The spindle's name on the control."},
      Key<OpcUa>{"machine_axes", &OpcUa::machine_axes, 1, 128,
                 "Names of the machine axes on the control, in order, with blanks between; by "
                 "default `X1 Y1 Z1` and so on."},
      Key<OpcUa>{"plc_block", &OpcUa::plc_block, 1, 4000,
                 "STEADYREST.SCL: number of its data block and function block; the next number is "
                 "the instance's. The mapping names the same data block."},
      Key<OpcUa>{"spindle_axis", &OpcUa::spindle_axis, 1, 31,
                 "STEADYREST.SCL: number of the spindle's machine axis; its data block is 30 + "
                 "this."},
      Key<OpcUa>{"program", &OpcUa::program, 1, 1024,
                 "The NC program that the control runs, as a file of this computer, from this "
                 "file's folder on; `--program` takes its place."},
  };
  return kKeys;
}

std::span<const Key<MappingEntry>> mapping_keys() noexcept {
  static const std::array kKeys = {
      Key<MappingEntry>{"quantity", &MappingEntry::quantity, 1, 64, "What the node means.",
                        Need::mandatory},
      Key<MappingEntry>{
          "node", &MappingEntry::node, 1, 400,
          "Its identifier, `s=…` or `i=…`, with {channel}, {channel_db}, "
          "{plc_block}, {axis}, {sample}, {sample_count}, {order} and {order_count} filled in.",
          Need::mandatory},
      Key<MappingEntry>{"index", &MappingEntry::index, -1, 1023,
                        "Entry of an array, from 0 on; −1: the last one."},
      Key<MappingEntry>{"step", &MappingEntry::step, 0, 128,
                        "Quantities of axes: from one axis's entry to the next one's."},
      Key<MappingEntry>{"length", &MappingEntry::length, 1, 1024,
                        "Entries of the array; `#N]` in the node says it too."},
      Key<MappingEntry>{"scale", &MappingEntry::scale, -1e9, 1e9,
                        "The quantity is scale · shown + offset."},
      Key<MappingEntry>{"offset", &MappingEntry::offset, -1e9, 1e9, "See scale."},
  };
  return kKeys;
}

}  // namespace steadyrest::passport
