// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/nc/interpret/program_variables.hpp>

namespace steadyrest::nc::interpret {

void ProgramVariables::bind(Variables kind, Parameters& parameters, read::Reader& reader) {
  switch (kind) {
    case Variables::parameters:
      reader.set_values(&parameters);
      break;
    case Variables::macros:
      reader.set_values(&macro);
      break;
    case Variables::typed:
      reader.set_typed_values(&typed);
      break;
    case Variables::q:
      reader.set_values(&q);
      break;
  }
}

void ProgramVariables::list(Variables kind, const Parameters& parameters,
                            std::vector<std::pair<std::string, double>>& out) const {
  switch (kind) {
    case Variables::parameters:
      parameters.list(out);
      break;
    case Variables::macros:
      macro.list(out);
      break;
    case Variables::typed:
      typed.list(out);
      break;
    case Variables::q:
      q.list(out);
      break;
  }
}

}  // namespace steadyrest::nc::interpret
