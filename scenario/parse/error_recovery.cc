// SPDX-License-Identifier: BSD-3-Clause
// Splits the text into tokens and finds the field around an error by its name, brackets and
// separators.
#include "scenario/parse/error_recovery.h"

#include <algorithm>
#include <map>
#include <vector>

namespace ergocast {
namespace {

using Index = std::size_t;

constexpr int kTabWidth = 8;  // as in Protobuf's tokenizer

int next_column(char c, int column) {
  return c == '\t' ? column + kTabWidth - column % kTabWidth : column + 1;
}

struct Token {
  std::size_t begin, end;
  std::string_view text;
  int line;
};

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool in_word(char c) { return is_digit(c) || is_letter(c) || c == '.' || c == '+' || c == '-'; }

/// The end of the token that begins at `begin`: a string, a word or a number, or one character.
std::size_t token_end(std::string_view text, std::size_t begin) {
  const char first = text[begin];
  std::size_t end = begin + 1;
  if (first == '"' || first == '\'') {
    while (end < text.size() && text[end] != '\n' && text[end] != first) {
      end += text[end] == '\\' && end + 1 < text.size() && text[end + 1] != '\n' ? 2 : 1;
    }
    return end < text.size() && text[end] == first ? end + 1 : end;
  }
  if (in_word(first)) {
    while (end < text.size() && in_word(text[end])) ++end;
  }
  return end;
}

/// Simpler than Protobuf's own tokenizer, but it also accepts text with errors.
std::vector<Token> tokens_of(std::string_view text) {
  std::vector<Token> tokens;
  int line = 0;
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] == '#') {
      at = std::min(text.find('\n', at), text.size());
    } else if (static_cast<unsigned char>(text[at]) <= ' ') {
      line += text[at++] == '\n' ? 1 : 0;
    } else {
      const std::size_t end = token_end(text, at);
      tokens.push_back({at, end, text.substr(at, end - at), line});
      at = end;
    }
  }
  return tokens;
}

/// Cuts a token: it may be as long as the file.
std::string shown(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  std::size_t end = std::min(text.size(), kLongest);
  const auto within_character = [&] {
    return (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80;
  };
  while (end < text.size() && end > 0 && within_character()) --end;
  return std::string(text.substr(0, end)) + (end < text.size() ? "…" : "");
}

bool is_word(const Token& token) { return in_word(token.text.front()); }
bool opens(const Token& token) { return token.text == "{" || token.text == "<"; }
bool closes(const Token& token) { return token.text == "}" || token.text == ">"; }
bool nests(const Token& token) { return opens(token) || token.text == "["; }
bool unnests(const Token& token) { return closes(token) || token.text == "]"; }

/// Whether tokens[i] is a field's name, judged by the next token.
bool names_field(const std::vector<Token>& tokens, Index i) {
  return i + 1 < tokens.size() && is_word(tokens[i]) &&
         (tokens[i + 1].text == ":" || opens(tokens[i + 1]));
}

/// The token at `offset`, or the next one.
Index token_at(const std::vector<Token>& tokens, std::size_t offset) {
  const auto at = std::find_if(tokens.begin(), tokens.end(),
                               [&](const Token& token) { return token.end > offset; });
  const bool after_open_string = at != tokens.begin() && (at - 1)->end == offset &&
                                 ((at - 1)->text[0] == '"' || (at - 1)->text[0] == '\'');
  const bool inside = at != tokens.end() && at->begin <= offset;
  return static_cast<Index>(at - tokens.begin()) - (after_open_string && !inside ? 1 : 0);
}

/// The first token of the field with the wrong token `at`.
Index field_begin(const std::vector<Token>& tokens, Index at, std::string_view message) {
  if (at >= 2 && tokens[at - 1].text == ":" && is_word(tokens[at - 2])) return at - 2;
  const bool after_name = tokens[at].text == ":" || opens(tokens[at]) ||
                          message.starts_with("Expected \":\"") ||
                          message.starts_with("Expected \"{\"");
  return after_name && at >= 1 && is_word(tokens[at - 1]) ? at - 1 : at;
}

/// One past the end of the block that begins at tokens[open].
Index block_end(const std::vector<Token>& tokens, Index open) {
  int depth = 0;
  for (Index i = open; i < tokens.size(); ++i) {
    depth += nests(tokens[i]) ? 1 : unnests(tokens[i]) ? -1 : 0;
    if (depth == 0) return i + 1;
  }
  return tokens.size();
}

/// One past the last token of the field that begins at `begin` and is wrong at `at`.
Index field_end(const std::vector<Token>& tokens, Index begin, Index at) {
  const bool value_is_missing = at > begin && (closes(tokens[at]) || names_field(tokens, at));
  if (value_is_missing) return at;
  for (Index i = at; i < tokens.size() && i <= at + 1; ++i) {
    if (nests(tokens[i]) && (i == at || tokens[at].text == ":")) return block_end(tokens, i);
  }
  Index end = at + 1;
  if (closes(tokens[at])) return end;
  while (end < tokens.size() && tokens[end].line == tokens[at].line && !closes(tokens[end]) &&
         !names_field(tokens, end)) {
    ++end;
  }
  return end;
}

/// The name of the block that begins at tokens[open]; `list` if it is an element of a list.
Index name_of_block(const std::vector<Token>& tokens, Index open, Index list) {
  if (open == 0) return 0;
  const std::string_view before = tokens[open - 1].text;
  if (before == "[" || before == ",") return list;
  return before == ":" && open >= 2 ? open - 2 : open - 1;
}

/// The path of the field whose name is tokens[name].
std::string path_of(const std::vector<Token>& tokens, Index name) {
  std::vector<std::string> blocks{""};
  std::map<std::string, int> count;
  const auto child = [&](Index i) { return blocks.back() + std::string(tokens[i].text); };
  Index list = 0;  // the name of the last list "name: [ { … }, { … } ]"
  for (Index i = 0; i < name; ++i) {
    if (tokens[i].text == "[") list = i >= 2 ? i - 2 : 0;
    if (opens(tokens[i])) {
      const Index word = name_of_block(tokens, i, list);
      std::string path = child(word);
      if (tokens[word].text == "gaussians" || tokens[word].text == "starts") {
        const int index = count[path]++;
        path = path + "[" + std::to_string(index) + "]";
      }
      blocks.push_back(path + ".");
    } else if (closes(tokens[i]) && blocks.size() > 1) {
      blocks.pop_back();
    }
  }
  return child(name);
}

/// "name: 1,5", which the parser reads as a number, a separator and another field called 5. It
/// reports the token after that.
std::optional<BrokenField> decimal_comma(const std::vector<Token>& tokens, Index at) {
  for (Index fraction = at; fraction + 1 >= at && fraction >= 4; --fraction) {
    const Token& whole = tokens[fraction - 2];
    if (tokens[fraction - 1].text == "," && tokens[fraction - 3].text == ":" &&
        is_digit(tokens[fraction].text[0]) && tokens[fraction].begin == whole.end + 1) {
      return BrokenField{tokens[fraction - 4].begin,
                         tokens[fraction].end,
                         whole.begin,
                         path_of(tokens, fraction - 4),
                         shown(whole.text) + "," + shown(tokens[fraction].text),
                         true};
    }
  }
  return std::nullopt;
}

}  // namespace

std::size_t offset_of(std::string_view text, Place place) {
  std::size_t offset = 0;
  for (int line = 0; line < place.line; ++line) {
    const std::size_t end = text.find('\n', offset);
    if (end == std::string_view::npos) return text.size();
    offset = end + 1;
  }
  for (int column = 0; column < place.column && offset < text.size(); ++offset) {
    column = next_column(text[offset], column);
  }
  return offset;
}

Place place_of(std::string_view text, std::size_t offset) {
  Place place;
  for (std::size_t i = 0; i < std::min(offset, text.size()); ++i) {
    if (text[i] == '\n') {
      place = {place.line + 1, 0};
    } else {
      place.column = next_column(text[i], place.column);
    }
  }
  return place;
}

std::optional<BrokenField> broken_field(std::string_view text, std::size_t offset,
                                        std::string_view message) {
  const std::vector<Token> tokens = tokens_of(text);
  Index at = token_at(tokens, offset);
  // The parser reports an invalid word one token late.
  const bool late = message.starts_with("Unknown enumeration value") ||
                    message.starts_with("Invalid value for boolean");
  if (late && at > 0) --at;
  if (at >= tokens.size()) return std::nullopt;
  if (const auto comma = decimal_comma(tokens, at)) return comma;
  const Index begin = field_begin(tokens, at, message);
  const Index end = field_end(tokens, begin, at);
  const bool named = is_letter(tokens[begin].text[0]) && (begin < at || names_field(tokens, begin));
  return BrokenField{tokens[begin].begin, tokens[end - 1].end, tokens[at].begin,
                     named ? path_of(tokens, begin) : "", shown(tokens[at].text)};
}

std::optional<std::size_t> unclosed_block(std::string_view text) {
  std::vector<std::size_t> open;
  for (const Token& token : tokens_of(text)) {
    if (opens(token)) open.push_back(token.begin);
    if (closes(token) && !open.empty()) open.pop_back();
  }
  if (open.empty()) return std::nullopt;
  return open.back();
}

std::optional<std::size_t> too_deep(std::string_view text, int limit) {
  int depth = 0;
  for (const Token& token : tokens_of(text)) {
    if (nests(token) && ++depth > limit) return token.begin;
    if (unnests(token) && depth > 0) --depth;
  }
  return std::nullopt;
}

}  // namespace ergocast
