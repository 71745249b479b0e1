// SPDX-License-Identifier: BSD-3-Clause
// A small C++ tokenizer collects the texts that a function composes, and searches for them in the
// output.
#include "tests/checks_can_fail/words.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>

namespace ergocast::test {
namespace {

struct Token {
  enum Kind { kWord, kText, kSign } kind;
  std::string text;
  int line;
};
using Tokens = std::vector<Token>;

bool in_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// One past the quoted text that begins at `at`.
std::size_t end_of_quoted(const std::string& source, std::size_t at) {
  const char quote = source[at];
  for (++at; at < source.size() && source[at] != quote; ++at) at += source[at] == '\\' ? 1 : 0;
  return at + 1;
}

std::string unescaped(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\\' || i + 1 == text.size()) {
      out += text[i];
    } else {
      constexpr std::string_view kNames = "ntr", kMeant = "\n\t\r";
      const auto at = kNames.find(text[++i]);
      out += at == kNames.npos ? text[i] : kMeant[at];
    }
  }
  return out;
}

/// C++ without its comments, directives and character literals; adjacent texts are one.
Tokens tokens_of(const std::string& source) {
  Tokens tokens;
  int line = 1;
  for (std::size_t i = 0; i < source.size();) {
    const char c = source[i];
    std::size_t end = i + 1;
    if (c == '#' || source.compare(i, 2, "//") == 0) {
      end = std::min(source.find('\n', i), source.size());
    } else if (c == '"') {
      end = end_of_quoted(source, i);
      const std::string text = unescaped(source.substr(i + 1, end - i - 2));
      if (!tokens.empty() && tokens.back().kind == Token::kText) {
        tokens.back().text += text;
      } else {
        tokens.push_back({Token::kText, text, line});
      }
    } else if (c == '\'') {
      end = end_of_quoted(source, i);
    } else if (in_word(c)) {
      // 1'000 is one number.
      while (end < source.size() &&
             (in_word(source[end]) || (source[end] == '\'' && std::isdigit(c))))
        ++end;
      tokens.push_back({Token::kWord, source.substr(i, end - i), line});
    } else if (source.compare(i, 2, "::") == 0) {
      end = i + 2;
      tokens.push_back({Token::kSign, "::", line});
    } else if (std::isspace(static_cast<unsigned char>(c)) == 0) {
      tokens.push_back({Token::kSign, std::string(1, c), line});
    }
    line += static_cast<int>(std::count(
        source.begin() + static_cast<std::ptrdiff_t>(i),
        source.begin() + static_cast<std::ptrdiff_t>(std::min(end, source.size())), '\n'));
    i = end;
  }
  return tokens;
}

/// Replaces several spaces, or a line's end, by one space.
std::string on_one_line(const std::string& text) {
  static const std::regex kSpaces("\\s+");
  return std::regex_replace(text, kSpaces, " ");
}

/// The text between a format's conversions.
std::vector<std::string> pieces_of(const std::string& text) {
  static const std::regex kConversion("%[-+#0-9.*]*(ll|l|z)?[dufgsxXc%]?|\\{\\}");
  std::vector<std::string> pieces;
  for (std::sregex_token_iterator at(text.begin(), text.end(), kConversion, -1), end; at != end;
       ++at) {
    if (at->length() > 0) pieces.push_back(on_one_line(*at));
  }
  return pieces;
}

/// Whether it has a letter and a space outside conversions.
bool is_words(const std::string& text) {
  static const std::regex kWords("[A-Za-z][^A-Za-z]* | [^A-Za-z]*[A-Za-z]");
  const std::vector<std::string> pieces = pieces_of(text);
  return std::any_of(pieces.begin(), pieces.end(),
                     [](const std::string& piece) { return std::regex_search(piece, kWords); });
}

/// The begin and end of `condition ? one : other`; the branches of a nested condition are separate
/// branches.
class Branches {
 public:
  void pass(const std::string& sign, std::vector<std::vector<std::string>>& alternatives) {
    if (sign == "(" || sign == "{" || sign == "[") ++depth_;
    if (sign == "?" && (begun_ < 0 || depth_ < begun_)) begun_ = depth_;
    if (sign == "?" || (sign == ":" && inside())) alternatives.emplace_back();
    if (sign == "," && depth_ == begun_) begun_ = -1;
    if (sign == ")" || sign == "}" || sign == "]") --depth_;
    if (depth_ < begun_) begun_ = -1;
  }
  bool inside() const { return begun_ >= 0; }

 private:
  int depth_ = 1000, begun_ = -1;  // a statement may end at a greater depth than it began
};

/// One file, and the texts of each function in it.
struct Reader {
  std::string path;
  Tokens tokens;
  std::vector<std::size_t> opened;    // for each token: the enclosing "(", or npos
  std::vector<std::string> function;  // for each token: its function
  std::vector<std::pair<std::string, Saying>> statements;  // with their functions
  static constexpr std::size_t kNone = std::string::npos;

  Reader(std::string file, const std::string& source)
      : path(std::move(file)), tokens(tokens_of(source)) {
    find_places();
    read_statements();
  }

  std::string word_before(std::size_t at) const {
    return at > 0 && tokens[at - 1].kind == Token::kWord ? tokens[at - 1].text : "";
  }

  /// The function whose body the brace at `at` opens; empty if it opens none.
  std::string function_opened(std::size_t at,
                              const std::map<std::size_t, std::size_t>& open_of) const {
    static const std::set<std::string> kNoFunction = {"if", "for", "while", "switch", "catch", ""};
    std::size_t i = at;
    while (i > 0 && (word_before(i) == "const" || word_before(i) == "override" ||
                     word_before(i) == "noexcept"))
      --i;
    if (i == 0 || tokens[i - 1].text != ")") return "";
    const auto open = open_of.find(i - 1);
    const std::string name = open == open_of.end() ? "" : word_before(open->second);
    return kNoFunction.contains(name) ? "" : name;
  }

  void find_places() {
    std::vector<std::size_t> parens;
    std::vector<std::string> braces{""};
    std::map<std::size_t, std::size_t> open_of;  // of each ")"
    for (std::size_t i = 0; i < tokens.size(); ++i) {
      const bool sign = tokens[i].kind == Token::kSign;
      if (sign && tokens[i].text == ")" && !parens.empty()) {
        open_of[i] = parens.back();
        parens.pop_back();
      }
      if (sign && tokens[i].text == "{") {
        const std::string name = function_opened(i, open_of);
        braces.push_back(name.empty() ? braces.back() : name);
      }
      if (sign && tokens[i].text == "}" && braces.size() > 1) braces.pop_back();
      opened.push_back(parens.empty() ? kNone : parens.back());
      function.push_back(braces.back());
      if (sign && tokens[i].text == "(") parens.push_back(i);
    }
  }

  /// Whether the text at `i` is only searched for, and not printed.
  bool is_asked_for(std::size_t i) const {
    static const std::set<std::string> kAsking = {"starts_with", "ends_with", "find", "contains",
                                                  "sound",       "getenv",    "at",   "value",
                                                  "output_of",   "rfind",     "regex"};
    for (std::size_t open = opened[i]; open != kNone; open = opened[open]) {
      if (kAsking.contains(word_before(open))) return true;
    }
    return false;
  }

  void read_statements() {
    Saying saying;
    bool all_is_well = false;
    Branches branches;
    for (std::size_t i = 0; i < tokens.size(); ++i) {
      const Token& token = tokens[i];
      if (token.text == "kOk") all_is_well = true;
      if (token.text == "kNote" || token.text == "kWarning" || token.text == "kProblem")
        all_is_well = false;
      if (token.kind == Token::kSign) branches.pass(token.text, saying.alternatives);
      if (token.kind == Token::kText && is_words(token.text) && !is_asked_for(i)) {
        if (saying.place.empty()) saying.place = path + ":" + std::to_string(token.line);
        auto& parts = branches.inside() ? saying.alternatives.back() : saying.parts;
        for (std::string& piece : pieces_of(token.text)) parts.push_back(std::move(piece));
      }
      if (token.kind != Token::kSign || token.text != ";") continue;
      std::erase_if(saying.alternatives, [](const auto& one) { return one.empty(); });
      if (!saying.place.empty() && !all_is_well) statements.emplace_back(function[i], saying);
      saying = {};
      branches = {};
      all_is_well = false;
    }
  }

  /// The texts between the "(" at `open` and its ")".
  std::vector<std::string> texts_of_call(std::size_t open) const {
    std::vector<std::string> texts;
    for (std::size_t i = open + 1; i < tokens.size() && opened[i] != kNone && opened[i] >= open;
         ++i) {
      if (tokens[i].kind == Token::kText && !is_asked_for(i)) texts.push_back(tokens[i].text);
    }
    return texts;
  }
};

/// The texts of each function and of those it calls. Functions of one name count as one.
std::map<std::string, std::vector<Saying>> words_by_function(const std::vector<Reader>& readers) {
  std::map<std::string, std::map<std::string, Saying>> words;  // by function and place
  std::set<std::pair<std::string, std::string>> calls;         // caller, callee
  for (const Reader& reader : readers) {
    for (const auto& [function, saying] : reader.statements) words[function][saying.place] = saying;
    for (std::size_t i = 0; i + 1 < reader.tokens.size(); ++i) {
      if (reader.tokens[i + 1].text == "(")
        calls.emplace(reader.function[i], reader.tokens[i].text);
    }
  }
  words.erase("");
  for (bool grows = true; grows;) {
    grows = false;
    for (const auto& [caller, callee] : calls) {
      const auto said = words.find(callee);
      if (caller.empty() || caller == callee || said == words.end()) continue;
      const auto& passed_on = said->second;
      auto& own = words[caller];
      const std::size_t before = own.size();
      own.insert(passed_on.begin(), passed_on.end());
      grows = grows || own.size() > before;
    }
  }
  std::map<std::string, std::vector<Saying>> lists;
  for (const auto& [function, said] : words) {
    for (const auto& [place, saying] : said) lists[function].push_back(saying);
  }
  return lists;
}

/// Calls that only pass a name to a function with texts: the name must be in its output.
std::vector<Saying> sayings_of_calls(const Reader& reader,
                                     const std::map<std::string, std::vector<Saying>>& words) {
  std::vector<Saying> sayings;
  for (std::size_t i = 0; i + 1 < reader.tokens.size(); ++i) {
    const auto called = words.find(reader.tokens[i].text);
    if (called == words.end() || reader.tokens[i + 1].text != "(" || reader.function[i].empty())
      continue;
    const std::vector<std::string> texts = reader.texts_of_call(i + 1);
    const bool is_path = !texts.empty() && texts.front().find('/') != std::string::npos;
    if (texts.empty() || texts.front().size() < 3 || is_path) continue;
    if (std::any_of(texts.begin(), texts.end(), is_words)) continue;
    sayings.push_back({reader.path + ":" + std::to_string(reader.tokens[i].line),
                       {texts.front()},
                       {},
                       called->second});
  }
  return sayings;
}

std::vector<Saying> sayings_of(const std::vector<Reader>& readers) {
  const auto words = words_by_function(readers);
  std::vector<Saying> all;
  for (const Reader& reader : readers) {
    for (const auto& [function, saying] : reader.statements) all.push_back(saying);
    const auto calls = sayings_of_calls(reader, words);
    all.insert(all.end(), calls.begin(), calls.end());
  }
  return all;
}

/// Whether `text` has all parts, one after the other.
bool says_in_order(const std::string& text, const std::vector<std::string>& parts) {
  std::size_t at = 0;
  for (const std::string& part : parts) {
    at = text.find(part, at);
    if (at == std::string::npos) return false;
    at += part.size();
  }
  return true;
}

std::string joined(const std::vector<std::string>& parts) {
  std::string words;
  for (const std::string& part : parts) words += (words.empty() ? "" : " … ") + part;
  return words;
}

std::string words_of(const Saying& saying) {
  std::string words = joined(saying.parts);
  for (const auto& one : saying.alternatives) words += " | " + joined(one);
  return words;
}

}  // namespace

bool Saying::in(const std::string& text) const {
  if (!says_in_order(text, parts)) return false;
  const auto said = [&text](const auto& one) { return says_in_order(text, one); };
  if (!alternatives.empty() && parts.empty() &&
      std::none_of(alternatives.begin(), alternatives.end(), said)) {
    return false;
  }
  return or_else.empty() || std::any_of(or_else.begin(), or_else.end(),
                                        [&text](const Saying& one) { return one.in(text); });
}

std::vector<std::string> sources_in(const std::string& folder,
                                    const std::vector<std::string>& without) {
  namespace fs = std::filesystem;
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(fs::path(ERGOCAST_SOURCE_DIR) / folder)) {
    const std::string file = folder + "/" + entry.path().filename().string();
    const bool left_out = std::find(without.begin(), without.end(), file) != without.end();
    if (entry.path().extension() == ".cc" && !left_out) files.push_back(file);
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<Saying> sayings_of(const std::vector<std::string>& files) {
  std::vector<Reader> readers;
  for (const std::string& file : files) {
    std::ifstream in(std::filesystem::path(ERGOCAST_SOURCE_DIR) / file, std::ios::binary);
    readers.emplace_back(file, std::string(std::istreambuf_iterator<char>(in), {}));
  }
  return sayings_of(readers);
}

std::vector<std::string> never_said(const std::vector<Saying>& sayings,
                                    std::vector<std::string> said) {
  for (std::string& text : said) text = on_one_line(text);
  std::vector<std::string> missing;
  for (const Saying& saying : sayings) {
    std::vector<const std::string*> texts;
    for (const std::string& text : said) {
      if (saying.in(text)) texts.push_back(&text);
    }
    if (texts.empty()) {
      missing.push_back(saying.place + ": " + words_of(saying));
      continue;
    }
    for (const auto& one : saying.alternatives) {
      const auto says = [&one](const std::string* text) { return says_in_order(*text, one); };
      if (std::any_of(texts.begin(), texts.end(), says)) continue;
      missing.push_back(saying.place + ": " + joined(one) + ", of" + words_of(saying));
    }
  }
  return missing;
}

std::vector<std::string> said_twice(const std::vector<Saying>& sayings) {
  std::map<std::string, std::string> places;
  std::vector<std::string> twice;
  for (const Saying& saying : sayings) {
    static const std::regex kTwoWords("[A-Za-z]+[^A-Za-z]+[A-Za-z]");
    if (!saying.or_else.empty() || !std::regex_search(words_of(saying), kTwoWords)) continue;
    const auto [at, is_new] = places.emplace(words_of(saying), saying.place);
    if (!is_new) twice.push_back(at->second + " and " + saying.place + ": " + words_of(saying));
  }
  return twice;
}

}  // namespace ergocast::test
