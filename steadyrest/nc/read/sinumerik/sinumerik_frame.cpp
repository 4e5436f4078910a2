// SPDX-License-Identifier: Apache-2.0
#include <string_view>

#include <steadyrest/nc/read/sinumerik/sinumerik_line.hpp>
#include <steadyrest/nc/read/sinumerik/sinumerik_names.hpp>
#include <steadyrest/nc/read/text/character.hpp>

// Frames and tool data that a program writes ("Job planning", "Frames", "Tool offset memory"):
//
//   $P_UIFR[1]=CTRANS(X,10,Y,20):CROT(Z,30)   the stored frame of G54
//   $P_UIFR[2,Z,TR]=-5                        one of its components
//   $P_PFRAME=CTRANS(X,10)                    the programmed frame
//   $TC_DP3[1,1]=120                          tool data
//
// A frame becomes words without a letter: its name with its number, then one for each axis (X, Y …)
// and one for the rotation about Z (CROT). The name has a value where the whole frame is replaced.
namespace steadyrest::nc::read {
namespace {

constexpr std::string_view kFrameForm =
    "write a frame as $P_UIFR[n]=CTRANS(X,value,...):CROT(Z,value), $P_UIFR[n,X,TR]=value or "
    "$P_PFRAME=CTRANS(...):CROT(Z,value)";

}  // namespace

// at_ is behind $P_UIFR or $P_PFRAME.
bool SinumerikLine::stored_offset(const char* word_begin) {
  Word word;
  word.qualifier = Qualifier::stored;
  word.name = since(word_begin);
  if (word.name.ends_with('R') || word.name.ends_with('r')) {  // $P_UIFR
    if (next() != '[') {
      at_ = end_;
      return refuse(since(word_begin), "parameter", kFrameForm);
    }
    ++at_;
    if (!calculated(word_begin, word.value)) {
      return false;
    }
    if (next() == ',') {
      ++at_;
      return push(word_begin, word) && offset_shift(word_begin);
    }
    if (next() != ']') {
      at_ = end_;
      return refuse(since(word_begin), "parameter", kFrameForm);
    }
    ++at_;
  }
  if (next() != '=') {
    at_ = end_;
    return refuse(since(word_begin), "parameter", kFrameForm);
  }
  ++at_;
  word.has_value = true;
  return push(word_begin, word) && offset_chain(word_begin);
}

// CTRANS(X,1,Y,2), CROT(Z,30) or both in this order.
bool SinumerikLine::offset_chain(const char* word_begin) {
  bool shifted = false;
  for (;;) {
    skip_blanks();
    const std::string_view name = letters();
    const bool shift = equal(name, "CTRANS") && !shifted;
    if ((!shift && !equal(name, "CROT")) || next() != '(') {
      at_ = end_;
      return refuse(since(word_begin), "frame",
                    "a frame of other parts than CTRANS and, behind it, CROT about Z");
    }
    shifted = true;
    ++at_;
    while (next() != ')') {
      Word word;
      word.qualifier = Qualifier::stored;
      word.has_value = true;
      const char* const part = at_;
      char axis = 0;
      if (!axis_letter(axis) || !take(",") || (!shift && axis != 'Z')) {
        at_ = end_;
        return refuse(since(word_begin), "frame", kFrameForm);
      }
      word.name = shift ? std::string_view{part, 1} : name;
      if (!calculated(word_begin, word.value) || !push(part, word)) {
        return false;
      }
      if (next() == ',') {
        ++at_;
      } else if (next() != ')') {
        at_ = end_;
        return refuse(since(word_begin), "unclosed_expression", "a frame that is not closed by )");
      }
    }
    ++at_;
    if (next() != ':') {
      assigned_ = true;
      return next() == '\0' || refuse(since(word_begin), "frame", kFrameForm);
    }
    if (!shift) {
      at_ = end_;
      return refuse(since(word_begin), "frame", kFrameForm);
    }
    ++at_;
  }
}

// [1,X,TR]=…, [1,Z,RT]=…; at_ is behind the first comma.
bool SinumerikLine::offset_shift(const char* word_begin) {
  Word word;
  word.qualifier = Qualifier::stored;
  word.has_value = true;
  skip_blanks();
  const char* const part = at_;
  char axis = 0;
  const bool read = axis_letter(axis) && take(",");
  const bool shift = read && take("TR");
  const bool turn = read && !shift && axis == 'Z' && take("RT");
  if ((!shift && !turn) || !take("]") || !take("=")) {
    at_ = end_;
    return refuse(since(word_begin), "parameter", kFrameForm);
  }
  word.name = shift ? std::string_view{part, 1} : std::string_view{"CROT"};
  if (!calculated(word_begin, word.value) || !push(part, word)) {
    return false;
  }
  assigned_ = true;
  return true;
}

// $TC_DP3[1,1]=120, $TC_TP2[1]="MILL": at_ is behind $TC_.
bool SinumerikLine::tool_data(const char* word_begin) {
  Word word;
  if (letters().empty() || next() != '[' || !pass_brackets(word_begin, '[', ']') || next() != '=') {
    at_ = end_;
    return refuse(since(word_begin), "parameter", "write tool data as $TC_DP3[1,1]=value");
  }
  ++at_;
  skip_blanks();
  word.name = "$TC";
  if (at_ != end_ && *at_ == '"') {
    if (!quoted(word_begin, word)) {
      return false;
    }
  } else if (!calculated(word_begin, word.value) || !push(word_begin, word)) {
    return false;
  }
  assigned_ = true;
  return true;
}

}  // namespace steadyrest::nc::read
