#include "flexura/kinematics/expression.h"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <numbers>

namespace flexura {
namespace {

constexpr std::size_t longest_expression = 1000;

// Returns the position of an assignment. muParser lets a formula assign to its variables ("t = 3"); here that
// is a typing error for "==".
std::size_t find_assignment(const std::string& text) {
  for (std::size_t at = text.find('='); at != std::string::npos; at = text.find('=', at + 1)) {
    const bool compares_before =
        at > 0 && std::string_view("=<>!").find(text[at - 1]) != std::string_view::npos;
    const bool compares_after = at + 1 < text.size() && text[at + 1] == '=';
    if (!compares_before && !compares_after) return at;
  }
  return std::string::npos;
}

// Limits the input: muParser recurses or grows its stack without limit on consecutive brackets and signs.
void check_text(const std::string& text) {
  if (text.size() > longest_expression) {
    throw ExpressionError(fmt::format("is longer than {} characters", longest_expression),
                          longest_expression);
  }
  const auto odd = std::ranges::find_if(text, [](unsigned char c) { return c < ' ' || c > '~'; });
  if (odd != text.end()) {
    throw ExpressionError("contains a character that is not allowed in a formula",
                          static_cast<std::size_t>(odd - text.begin()));
  }
  if (const std::size_t at = text.find('"'); at != std::string::npos) {
    throw ExpressionError("contains a text in quotes: expected numbers, names and operators", at);
  }
  if (const std::size_t at = find_assignment(text); at != std::string::npos) {
    throw ExpressionError("assigns a value: expected == for a comparison", at);
  }
}

// Returns the error without its position. muParser writes positions into its messages, from 0, and one behind
// a call if its arguments are wrong. Here the message has the error, and `position` the place.
std::string message_of(const mu::ParserError& error) {
  std::string message = error.GetMsg();
  for (const char* place : {" found at position", " at position", " at expression position",
                            " starting at position", " (position"}) {
    message.resize(std::min(message.find(place), message.size()));
  }
  while (!message.empty() && (message.back() == '.' || message.back() == '\n')) message.pop_back();
  // muParser adds a space after the formula.
  if (message.ends_with(" \"")) message.erase(message.size() - 2, 1);
  if (!message.empty()) message[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(message[0])));
  return message;
}

// Returns the position of the name of the function whose brackets close last up to `position`.
std::size_t find_call(const std::string& text, const std::string& function, std::size_t position) {
  std::size_t at = text.find_last_of(')', position);
  if (at == std::string::npos) return text.rfind(function, position);
  for (int depth = 1; depth > 0 && at > 0;) {
    --at;
    if (text[at] == ')') ++depth;
    if (text[at] == '(') --depth;
  }
  return text.rfind(function, at);
}

std::size_t position_of(const mu::ParserError& error, const std::string& text) {
  const auto reported = static_cast<std::size_t>(error.GetPos());
  if (error.GetPos() < 0) return 0;  // Error of the whole formula.
  const bool is_of_call = error.GetCode() == mu::ecTOO_MANY_PARAMS || error.GetCode() == mu::ecTOO_FEW_PARAMS;
  const std::size_t found = is_of_call ? find_call(text, error.GetToken(), reported) : reported;
  return std::min(found == std::string::npos ? reported : found, text.size());
}

}  // namespace

struct Expression::Parser {
  mu::Parser parser;
  double t = 0;
  double T = 1;
  double i = 1;
};

Expression::Expression(const std::string& text) : parser_(std::make_unique<Parser>()) {
  check_text(text);
  try {
    parser_->parser.ClearConst();  // muParser's own _pi is wrong in the 13th digit.
    parser_->parser.DefineConst("pi", std::numbers::pi);
    parser_->parser.DefineVar("t", &parser_->t);
    parser_->parser.DefineVar("T", &parser_->T);
    parser_->parser.DefineVar("i", &parser_->i);
    parser_->parser.SetExpr(text);
    parser_->parser.Eval();
    if (parser_->parser.GetNumResults() != 1)
      throw ExpressionError("has several values: expected one value", text.find(','));
  } catch (const mu::ParserError& error) {
    throw ExpressionError(message_of(error), position_of(error, text));
  }
}

Expression::~Expression() = default;
Expression::Expression(Expression&&) noexcept = default;
Expression& Expression::operator=(Expression&&) noexcept = default;

double Expression::value(double t, double T, std::size_t section_number) const {
  parser_->t = t;
  parser_->T = T;
  parser_->i = static_cast<double>(section_number);
  try {
    return parser_->parser.Eval();
  } catch (const mu::ParserError&) {
    // Some functions refuse arguments instead of returning NaN.
    return std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace flexura
