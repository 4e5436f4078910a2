// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <utility>

#include <steadyrest/nc/read/sinumerik/sinumerik_expression.hpp>
#include <steadyrest/nc/read/sinumerik/sinumerik_line.hpp>
#include <steadyrest/nc/read/sinumerik/sinumerik_names.hpp>
#include <steadyrest/nc/read/text/character.hpp>

// Definitions of variables and subprograms, and strings, of the dialect `sinumerik`.
namespace steadyrest::nc::read {
namespace {

constexpr std::string_view kOwnBlock = "a definition needs a separate block";
constexpr std::size_t kMostElements = 10'000;  // of one array
constexpr std::size_t kMostDimensions = 3;     // "Job planning", "Arrays"
constexpr std::size_t kLongestText = 200;      // "Job planning", STRING

/// `[2,0]` behind a name; false when it does not fit.
bool push_index(Name& name, char before, std::size_t index) {
  std::array<char, 24> digits{};
  const auto end = std::to_chars(digits.begin(), digits.end(), index).ptr;
  return name.push(before) &&
         std::all_of(digits.begin(), end, [&](char c) { return name.push(c); });
}

}  // namespace

// The types whose value is a number.
bool SinumerikLine::value_type(const char* word_begin, ValueType& type) {
  struct Type {
    std::string_view name;
    ValueType type;
  };
  constexpr std::array kTypes = {Type{"REAL", ValueType::real}, Type{"INT", ValueType::integer},
                                 Type{"BOOL", ValueType::boolean},
                                 Type{"CHAR", ValueType::character}};
  const std::string_view name = letters();
  const auto* const found =
      std::ranges::find_if(kTypes, [&](const Type& one) { return equal(name, one.name); });
  if (found != kTypes.end()) {
    type = found->type;
    return true;
  }
  // Axes and frames are not numbers.
  return refuse(since(word_begin), "definition",
                "a variable or parameter of an unsupported type; REAL, INT, BOOL, CHAR and, for "
                "variables, STRING are supported (not AXIS, FRAME, SYN…)");
}

bool SinumerikLine::variable_name(const char* word_begin, Name& name) {
  const std::string_view written = letters();
  // The manual's rule: two leading letters or underscores tell variables from addresses such as X1.
  const bool starts = written.size() >= 2 && !is_digit(written[0]) && !is_digit(written[1]);
  if (!starts || written.size() > 31 || known_name(written) || refused_name(written) != nullptr ||
      is_flow_word(written) || !lower_name(written, name)) {
    return refuse(since(word_begin), "bad_name",
                  "a variable name: begin with two letters or underscores, at most 31 characters, "
                  "no word of the language");
  }
  return true;
}

// DEF REAL A, B=2.5, C[3]; DEF STRING[20] NOTE="TOP"
bool SinumerikLine::definition(const char* word_begin) {
  ValueType type{};
  if (!block_.words().empty() || assigned_) {
    return refuse(since(word_begin), "definition", kOwnBlock);
  }
  skip_blanks();
  if (equal(rest().substr(0, 6), "STRING")) {
    return definition_of_text(word_begin);
  }
  if (!value_type(word_begin, type)) {
    return false;
  }
  // Definitions act at once, one after the other: `DEF REAL A=2, B=A*2` is allowed.
  for (;;) {
    Name name;
    double value = 0.0;
    if (!variable_name(word_begin, name)) {
      return false;
    }
    if (next() == '[') {
      if (!definition_of_array(word_begin, name, type)) {
        return false;
      }
    } else {
      if (next() == '=') {
        ++at_;
        if (!calculated(word_begin, value)) {
          return false;
        }
      }
      if (!reading_.typed_values->define(name.view(), type, value)) {
        return refuse(since(word_begin), "definition", "a variable that is already defined");
      }
    }
    if (next() != ',') {
      return next() == '\0' || refuse(since(word_begin), "definition", kOwnBlock);
    }
    ++at_;
  }
}

// NAME[2,3], NAME[3]=SET(1,2), NAME[3]=(1,2), NAME[3]=REP(0): the last index runs first.
bool SinumerikLine::definition_of_array(const char* word_begin, Name& name, ValueType type) {
  std::array<std::size_t, kMostDimensions> sizes{};
  std::size_t dimensions = 0;
  std::size_t count = 1;
  do {
    ++at_;  // [ or ,
    double size = 0.0;
    if (!calculated(word_begin, size)) {
      return false;
    }
    if (dimensions == kMostDimensions || size != std::floor(size) || size < 1.0 ||
        size * static_cast<double>(count) > static_cast<double>(kMostElements)) {
      return refuse(since(word_begin), "array",
                    "an array of more than 3 dimensions or 10000 elements, or of a size that is "
                    "not a whole number from 1");
    }
    sizes.at(dimensions++) = static_cast<std::size_t>(size);
    count *= static_cast<std::size_t>(size);
  } while (next() == ',');
  if (next() != ']') {
    return refuse(since(word_begin), "unclosed_expression", "an array that is not closed by ]");
  }
  ++at_;
  std::vector<double> values;
  if (next() == '=') {
    ++at_;
    if (!array_values(word_begin, count, values)) {
      return false;
    }
  }
  values.resize(count);
  for (std::size_t element = 0; element < count; ++element) {
    Name key = name;
    std::size_t rest_of = element;
    std::size_t stride = count;
    bool fits = true;
    for (std::size_t i = 0; i < dimensions; ++i) {
      stride /= sizes.at(i);
      fits = fits && push_index(key, i == 0 ? '[' : ',', rest_of / stride);
      rest_of %= stride;
    }
    if (!fits || !key.push(']') ||
        !reading_.typed_values->define(key.view(), type, values[element])) {
      return refuse(since(word_begin), "definition", "a variable that is already defined");
    }
  }
  return true;
}

// Those that are left out stay 0.
bool SinumerikLine::array_values(const char* word_begin, std::size_t count,
                                 std::vector<double>& values) {
  const char* const from = (skip_blanks(), at_);
  const std::string_view how = letters();
  if (!(how.empty() || equal(how, "SET") || equal(how, "REP")) || next() != '(') {
    at_ = from;
    return refuse(since(word_begin), "array",
                  "an array's values are SET(1,2,…), (1,2,…) or REP(0)");
  }
  do {
    ++at_;
    double value = 0.0;
    if (values.size() == count || !calculated(word_begin, value)) {
      return values.size() == count
                 ? refuse(since(word_begin), "array", "more values than the array has elements")
                 : false;
    }
    values.push_back(value);
  } while (next() == ',');
  if (next() != ')') {
    return refuse(since(word_begin), "unclosed_expression", "an array's values without their )");
  }
  ++at_;
  if (equal(how, "REP")) {
    values.assign(count, values.front());
  }
  return true;
}

// `[R1,2]` behind the name of an array.
bool SinumerikLine::element_name(const char* word_begin, Name& name) {
  char before = '[';
  do {
    ++at_;
    double index = 0.0;
    if (!calculated(word_begin, index)) {
      return false;
    }
    if (index != std::floor(index) || index < 0.0 || index > 1e6 ||
        !push_index(name, before, static_cast<std::size_t>(index))) {
      return refuse(since(word_begin), "array", "an index that is not a whole number from 0");
    }
    before = ',';
  } while (next() == ',');
  if (next() != ']' || !name.push(']')) {
    return refuse(since(word_begin), "unclosed_expression", "an array that is not closed by ]");
  }
  ++at_;
  return true;
}

bool SinumerikLine::definition_of_text(const char* word_begin) {
  at_ += std::string_view{"STRING"}.size();
  double longest = 0.0;
  if (next() != '[' || (++at_, !calculated(word_begin, longest)) || next() != ']' ||
      !(longest >= 1.0 && longest <= static_cast<double>(kLongestText))) {
    return refuse(since(word_begin), "definition", "write DEF STRING[32] NAME, at most 200 long");
  }
  ++at_;
  for (;;) {
    Name name;
    std::string value;
    if (!variable_name(word_begin, name)) {
      return false;
    }
    if (next() == '[') {
      return refuse(since(word_begin), "array", "an array of strings is not interpreted");
    }
    if (next() == '=') {
      ++at_;
      if (!text_value(word_begin, value)) {
        return false;
      }
    }
    if (!reading_.typed_values->define_text(name.view(), value)) {
      return refuse(since(word_begin), "definition", "a variable that is already defined");
    }
    if (next() != ',') {
      return next() == '\0' || refuse(since(word_begin), "definition", kOwnBlock);
    }
    ++at_;
  }
}

// "text" << VARIABLE << R1: strings, STRING variables and whole numbers, one after the other.
bool SinumerikLine::text_value(const char* word_begin, std::string& out) {
  for (;;) {
    skip_blanks();
    if (rest().starts_with("<<")) {  // << before the first part is allowed
      at_ += 2;
      skip_blanks();
    }
    const char c = next();
    if (c == '"') {
      const char* const from = ++at_;
      at_ = std::find(at_, end_, '"');
      if (at_ == end_) {
        return refuse(since(word_begin), "unclosed_string", "a string without its closing quote");
      }
      out += since(from);
      ++at_;
    } else {
      const char* const from = at_;
      const std::string_view written = letters();
      Name name;
      const std::string* const text =
          lower_name(written, name) ? reading_.typed_values->text(name.view()) : nullptr;
      if (text != nullptr) {
        out += *text;
      } else {
        at_ = from;
        double value = 0.0;
        // Up to the next <<, of which an expression would take the first half for a comparison.
        const char* const whole_line =
            std::exchange(end_, at_ + std::min(rest().size(), rest().find("<<")));
        const bool read = calculated(word_begin, value);
        end_ = whole_line;
        if (!read) {
          return false;
        }
        static_cast<void>(reading_.values->take_unknown());
        // How the control writes fractions does not matter: only messages can contain them.
        std::array<char, 32> digits{};
        const auto end = std::to_chars(digits.begin(), digits.end(), value).ptr;
        out.append(digits.begin(), end);
      }
    }
    skip_blanks();
    if (!rest().starts_with("<<")) {
      return out.size() <= kLongestText ||
             refuse(since(word_begin), "bad_value", "a string of more than 200 characters");
    }
  }
}

bool SinumerikLine::parameter_of_subprogram(const char* word_begin, std::size_t place) {
  ValueType type{};
  Name name;
  double otherwise = 0.0;
  skip_blanks();
  const char* const from = at_;
  const bool returns = equal(letters(), "VAR");
  at_ = returns ? at_ : from;
  if (!value_type(word_begin, type)) {
    return false;
  }
  skip_blanks();
  const std::string_view written = letters();  // one letter is allowed here
  if (written.empty() || is_digit(written[0]) || !lower_name(written, name) || next() == '[') {
    return refuse(since(word_begin), "bad_name", "a parameter without a name, or an array");
  }
  if (returns) {
    return reading_.typed_values->define_reference(name.view(), type, place) ||
           refuse(since(word_begin), "definition",
                  "a VAR parameter for which the call gives no variable (DEF) of the same type; "
                  "R-parameters and elements of arrays are not interpreted here");
  }
  if (next() == '=') {
    ++at_;
    if (!calculated(word_begin, otherwise)) {
      return false;
    }
  }
  return reading_.typed_values->define_argument(name.view(), type, place, otherwise) ||
         refuse(since(word_begin), "definition", "a parameter that is already defined");
}

// PROC NAME(REAL A, INT B=3)
// A value that the caller leaves out takes the default in PROC, or 0.
bool SinumerikLine::head_of_subprogram(const char* word_begin) {
  if (letters().empty()) {
    return refuse(since(word_begin), "definition", "PROC without the subprogram's name");
  }
  if (next() == '(') {
    ++at_;
    // Values are matched by place, not by name.
    for (std::size_t place = 0; next() != ')'; ++place) {
      if (place > 0) {
        if (next() != ',') {
          return refuse(since(word_begin), "definition", "a , or ) is missing");
        }
        ++at_;
      }
      if (!parameter_of_subprogram(word_begin, place)) {
        return false;
      }
    }
    ++at_;
  }
  while (next() != '\0') {
    const std::string_view attribute = letters();
    // How the control shows the subprogram and where single block stops: nothing moves otherwise.
    constexpr std::array<std::string_view, 5> kHarmless = {"DISPLOF", "DISPLON", "SBLOF", "SBLON",
                                                           "ACTBLOCNO"};
    if (std::ranges::none_of(kHarmless,
                             [&](std::string_view one) { return equal(attribute, one); })) {
      at_ += attribute.empty() ? 1 : 0;
      return refuse(since(word_begin), "definition",
                    "a subprogram attribute that is not interpreted (SAVE, PREPRO …)");
    }
  }
  return true;
}

// EXTERN only declares a subprogram's parameters; PROC repeats them.
bool SinumerikLine::declaration(const char* word_begin) {
  at_ = end_;
  return block_.words().empty() || refuse(since(word_begin), "definition", kOwnBlock);
}

}  // namespace steadyrest::nc::read
