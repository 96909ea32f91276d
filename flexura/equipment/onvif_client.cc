#include "flexura/equipment/onvif_client.h"

#include <fmt/format.h>
#include <sys/random.h>

#include <algorithm>
#include <array>
#include <utility>

#include "flexura/base/bytes.h"
#include "flexura/base/one_line.h"
#include "flexura/equipment/onvif_http.h"

namespace flexura {
namespace {

// A camera's text for a message: one line, not too long.
std::string in_quotes(std::string_view text) {
  constexpr std::size_t most = 120;
  return "\"" + one_line(text.substr(0, most)) + (text.size() > most ? "..." : "") + "\"";
}

std::string fault_text(const SoapFault& fault) {
  if (fault.reason.empty()) return in_quotes(fault.code);
  return fault.code.empty() ? in_quotes(fault.reason) : in_quotes(fault.code + ": " + fault.reason);
}

}  // namespace

std::string onvif_host(const OnvifConfig& config) {
  return config.link.substr(std::string_view("tcp:").size());
}

std::string onvif_name(const OnvifConfig& config) { return config.link + ", ONVIF head"; }

OnvifLogin::OnvifLogin(std::string user, std::string password)
    : user_(std::move(user)), password_(std::move(password)) {}

void OnvifLogin::set_clock(double camera_time, double now) {
  const std::scoped_lock lock(mutex_);
  offset_ = camera_time - now;
}

std::optional<OnvifToken> OnvifLogin::token(double now) const {
  if (user_.empty()) return std::nullopt;
  std::array<char, 16> random{};
  if (::getrandom(random.data(), random.size(), 0) != static_cast<ssize_t>(random.size()))
    return std::nullopt;
  const std::string nonce(random.data(), random.size());
  std::optional<double> offset;
  {
    const std::scoped_lock lock(mutex_);
    offset = offset_;
  }
  const std::string created = onvif_time_text(now + offset.value_or(0));
  return OnvifToken{user_, onvif_digest(nonce, created, password_), base64(nonce), created};
}

// What became of one sending.
struct OnvifClient::Trial {
  enum class Kind { answered, refused, unauthorized, lost, closed } kind = Kind::lost;
  Answer answer;
  std::string what;  // A message without the camera's name.
  int status = 0;
  std::string authenticate;
};

OnvifClient::OnvifClient(OnvifPorts ports, const OnvifConfig& config, std::shared_ptr<OnvifLogin> login)
    : ports_(std::move(ports)),
      config_(config),
      name_(onvif_name(config)),
      host_(onvif_host(config)),
      login_(std::move(login)) {}

std::string OnvifClient::problem(const Request& request, std::string_view what) const {
  return fmt::format("{}: {}: {}", name_, request.name, what);
}

CommandOutcome OnvifClient::ask_clock() {
  const std::string body = onvif_ask_time();
  const auto answer = call({"GetSystemDateAndTime", config_.path, body, false});
  if (!answer) return *answer.fault();
  const auto time = parse_onvif_clock(answer.value().soap);
  if (!time)
    return PortFault{FaultKind::refused,
                     fmt::format("{}: does not report its time (UTC): set its clock", name_)};
  login_->set_clock(*time, answer.value().time);
  return Accepted{};
}

Outcome<OnvifClient::Answer> OnvifClient::call(const Request& request,
                                               const std::function<bool()>& is_wanted) {
  Trial trial;
  bool has_asked_clock = false;
  for (std::int64_t i = 0; i < config_.tries;) {
    if (is_wanted && !is_wanted())
      return PortFault{FaultKind::refused, name_ + ": the command was replaced by a halt"};
    const bool is_kept = link_ != nullptr;
    trial = try_once(request);
    if (trial.kind != Trial::Kind::answered) link_.reset();
    // A camera closes a connection that was idle. That is no failure.
    if (trial.kind != Trial::Kind::closed || !is_kept) ++i;
    if (trial.kind == Trial::Kind::answered) return std::move(trial.answer);
    if (trial.kind == Trial::Kind::refused) break;
    if (trial.kind == Trial::Kind::unauthorized) {
      // Its clock may have been set.
      if (has_asked_clock || !request.is_signed) break;
      has_asked_clock = true;
      if (const auto asked = ask_clock(); !asked) return *asked.fault();
    }
  }
  const bool is_lost = trial.kind == Trial::Kind::lost || trial.kind == Trial::Kind::closed;
  return PortFault{is_lost ? FaultKind::link_lost : FaultKind::refused, problem(request, trial.what)};
}

OnvifClient::Trial OnvifClient::try_once(const Request& request) {
  if (!link_) {
    auto opened = ports_.connect();
    if (!opened)
      return {.kind = Trial::Kind::lost, .answer = {}, .what = opened.fault()->what, .authenticate = {}};
    link_ = std::move(opened).value();
  }
  const auto token = request.is_signed ? login_->token(ports_.now()) : std::nullopt;
  return judged(request, exchange(http_post(host_, request.path, soap_message(request.body, token), true)));
}

OnvifClient::Trial OnvifClient::exchange(const std::string& message) {
  Trial trial;
  if (const auto sent = link_->write(message); !sent) {
    trial.kind = Trial::Kind::closed, trial.what = sent.fault()->what;
    return trial;
  }
  HttpReader reader(HttpReader::Side::replies);
  const double end = ports_.now() + config_.reply_timeout;
  bool has_heard = false;
  for (;;) {
    const double left = end - ports_.now();
    if (left <= 0) {
      trial.what = fmt::format("no {} within {:g} s: check power, network and address",
                               has_heard ? "complete answer" : "answer", config_.reply_timeout);
      return trial;
    }
    auto part = link_->read(left);
    std::optional<HttpMessage> reply;
    if (part) {
      has_heard = has_heard || !part.value().empty();
      reader.put(part.value());
      reply = reader.next();
    } else {
      reader.close();
      reply = reader.next();
      if (!reply && reader.problem().empty()) {
        trial.kind = has_heard ? Trial::Kind::lost : Trial::Kind::closed;
        trial.what = part.fault()->what;
        return trial;
      }
    }
    if (!reader.problem().empty()) {
      trial.what =
          fmt::format("its answer is not HTTP ({}): check address and port", one_line(reader.problem()));
      return trial;
    }
    if (!reply) continue;
    if (!reply->keeps_open) link_.reset();
    trial.status = reply->status, trial.authenticate = std::move(reply->authenticate);
    trial.kind = Trial::Kind::answered;
    trial.answer = {std::move(reply->body), ports_.now()};
    return trial;
  }
}

// Says what a reply means.
OnvifClient::Trial OnvifClient::judged(const Request& request, Trial trial) const {
  if (trial.kind != Trial::Kind::answered) return trial;
  constexpr int good = 200, unauthorized = 401;
  const auto fault = parse_soap_fault(trial.answer.soap);
  const bool is_login = (fault && (fault->code == "NotAuthorized" || fault->code == "FailedAuthentication" ||
                                   fault->code == "InvalidSecurity")) ||
                        trial.status == unauthorized;
  if (is_login) {
    trial.kind = Trial::Kind::unauthorized;
    if (config_.user.empty()) {
      trial.what = "a login is required: set user and password_file";
    } else if (!fault && trial.authenticate.find("Digest") != std::string::npos) {
      trial.what =
          "the camera accepts only an HTTP login: allow WS-Security (WS-UsernameToken) in its settings";
    } else {
      trial.what = "the login is refused: check user, password_file, and that the user may move the head";
    }
  } else if (fault) {
    trial.kind = Trial::Kind::refused;
    trial.what = "the head refuses: " + fault_text(*fault);
  } else if (trial.status != good) {
    trial.kind = Trial::Kind::refused;
    trial.what = fmt::format("HTTP status {}: check address, port and path", trial.status);
  } else if (!is_onvif_answer(trial.answer.soap, std::string(request.name) + "Response")) {
    trial.kind = Trial::Kind::lost;
    trial.what = "its answer is damaged or not an ONVIF answer: check address, port and path";
  }
  return trial;
}

}  // namespace flexura
