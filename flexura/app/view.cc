#include "flexura/app/view.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <ostream>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "embedded/examples.h"
#include "embedded/page.h"
#include "flexura/app/browser.h"
#include "flexura/app/campaign.h"
#include "flexura/app/commands.h"
#include "flexura/app/stop_signal.h"
#include "flexura/base/bytes.h"
#include "flexura/base/node.h"
#include "flexura/base/source.h"
#include "flexura/campaign/campaign_file.h"
#include "flexura/experiment/experiment.h"
#include "flexura/log/results.h"
#include "flexura/serve/gate.h"
#include "flexura/store/gzip.h"
#include "flexura/store/text_file.h"
#include "flexura/view/file_session.h"
#include "flexura/view/recording.h"
#include "flexura/vision/picture_file.h"

namespace flexura {
namespace {

constexpr std::uint16_t usual_port = 8421;
constexpr std::size_t largest_edited = std::size_t{1} << 26;

// Returns a name that differs for each start of the program. It is not secret, and no result depends on it.
std::string session_name() {
  std::random_device device;
  return fmt::format("{:08x}{:08x}", device(), device());
}

// Returns all examples, titled as in their files.
std::vector<ViewExample> offered_examples() {
  std::vector<ViewExample> offered;
  for (const embedded::Example& one : embedded::examples) {
    const std::string name(one.name);
    const Experiment experiment = parse_experiment(one.text, name);
    offered.push_back({name, experiment.title.empty() ? name : experiment.title,
                       [experiment] { return std::make_shared<const ViewedRig>(experiment); },
                       std::filesystem::path("results") / name, std::string(one.text)});
  }
  return offered;
}

// Returns whether a file holds the results of a campaign, by its ending or its content.
bool is_campaign(const std::string& what) {
  constexpr std::string_view mark = "SQLite format 3";
  if (std::filesystem::path(what).extension() == ".db") return true;
  std::error_code error;  // Errors are reported by whatever reads the file.
  if (!std::filesystem::is_regular_file(what, error)) return false;
  std::ifstream file(what, std::ios::binary);
  std::string start(mark.size(), ' ');
  return file.read(start.data(), static_cast<std::streamsize>(start.size())) && start == mark;
}

// Returns the rig of the first run whose experiment can be read, and the results of the campaign.
ViewStart start_of_campaign(const std::string& what) {
  constexpr std::int64_t most_tries = 100;
  const CampaignResults results(what);
  const std::int64_t runs = std::min(results.campaign().design().runs(), most_tries);
  ViewStart start;
  for (std::int64_t row = 0; start.rig == nullptr; ++row) {
    try {
      start.rig = std::make_shared<const ViewedRig>(results.campaign().experiment(row));
      start.results = default_replay_folder(what, row);
    } catch (const InputError&) {
      if (row + 1 >= runs) throw;
    }
  }
  start.stem = std::filesystem::path(what).stem().string();
  start.campaign = what;
  return start;
}

bool is_log(const std::filesystem::path& file) {
  return file.extension() == std::filesystem::path(log_file_name).extension();
}

// Returns whether a file is a picture: binary, but neither a log nor a campaign, or a PNM file, whose kind is
// a letter P and one character.
bool is_picture(const std::string& file) {
  std::error_code error;  // Errors are reported by whatever reads the file.
  if (!std::filesystem::is_regular_file(file, error) || is_log(file) || is_campaign(file)) return false;
  constexpr std::size_t enough = 512;
  std::string start(enough, ' ');
  std::ifstream stream(file, std::ios::binary);
  stream.read(start.data(), static_cast<std::streamsize>(enough));
  start.resize(static_cast<std::size_t>(stream.gcount()));
  if (start.find('\0') != std::string::npos) return true;
  constexpr std::string_view blanks = " \n\r\t";
  return start.size() > 2 && start[0] == 'P' && blanks.find(start[2]) != std::string_view::npos;
}

// Returns picture files under the names of the files. Equal names get numbers.
std::vector<ViewedPicture> pictures_of(const std::vector<std::string>& files) {
  if (files.size() > most_viewed_pictures)
    throw input_error(
        "WHAT", fmt::format("{} picture files: expected at most {}", files.size(), most_viewed_pictures));
  std::vector<ViewedPicture> pictures;
  std::map<std::string, int> count;
  for (const std::string& file : files) {
    const std::string text = read_text_file(file, most_picture_bytes);
    auto photograph = std::make_shared<const Photograph>(decode_picture(bytes_of(text), file));
    const int width = photograph->bytes.width(), height = photograph->bytes.height();
    if (std::max(width, height) > most_viewed_side)
      throw input_error(
          file, fmt::format("{} x {} px: expected at most {} px a side", width, height, most_viewed_side));
    std::string name = std::filesystem::path(file).filename().string();
    if (const int number = ++count[name]; number > 1) name += fmt::format(" ({})", number);
    pictures.push_back({std::move(name), std::move(photograph)});
  }
  return pictures;
}

ViewStart start_of(const std::vector<std::string>& arguments) {
  ViewStart start;
  if (arguments.size() > 1 || (arguments.size() == 1 && is_picture(arguments.front()))) {
    start.pictures = pictures_of(arguments);
    return start;
  }
  const std::string what = arguments.empty() ? "" : arguments.front();
  std::error_code error;  // Errors are reported by whatever reads the path.
  if (std::filesystem::is_directory(what, error)) {
    start.recording = std::make_shared<const Recording>(what);
    start.results = std::filesystem::path("results") / "view";
  } else if (is_log(what)) {
    throw input_error(what, "is a log: expected the results folder that contains this log");
  } else if (what.empty()) {
    start.rig = std::make_shared<const ViewedRig>(
        parse_experiment(embedded::examples.front().text, "the paper's arm"));
    start.results = std::filesystem::path("results") / "paper_arm";
    start.examples = offered_examples();
    start.text = embedded::examples.front().text;
    start.stem = "paper_arm";
  } else if (is_campaign(what)) {
    return start_of_campaign(what);
  } else {
    start.rig = std::make_shared<const ViewedRig>(load_experiment(what));
    start.results = default_results_folder(what);
    start.text = read_text_file(what, largest_edited);
    start.folder = std::filesystem::path(what).parent_path();
    start.stem = std::filesystem::path(what).stem().string();
  }
  return start;
}

// Rejects names that no browser could send: they would silently block every request.
void require_hosts(const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (!is_host(name))
      throw input_error("--name", fmt::format("{}: expected a host name or IP address, with or without a "
                                              "port, such as lab.example, lab.example:8421 or [::1]",
                                              text_node(name).brief()));
  }
}

bool listens_everywhere(const std::string& address) { return address == "0.0.0.0" || address == "::"; }

std::unique_ptr<ViewServer> serve(const ViewStart& start, const ViewerArguments& arguments,
                                  std::span<const Asset> assets) {
  std::array<unsigned char, sizeof(in6_addr)> parsed{};
  if (::inet_pton(AF_INET, arguments.address.c_str(), parsed.data()) != 1 &&
      ::inet_pton(AF_INET6, arguments.address.c_str(), parsed.data()) != 1)
    throw input_error("--address",
                      fmt::format("{}: expected an IP address of this machine, such as 127.0.0.1 or ::1",
                                  text_node(arguments.address).brief()));
  require_hosts(arguments.names);
  ServerConfig config;
  config.address = arguments.address;
  config.names = arguments.names;
  config.port = arguments.port.value_or(usual_port);
  try {
    return std::make_unique<ViewServer>(start, config, assets);
  } catch (const std::system_error&) {
    if (arguments.port) throw;
  }
  config.port = 0;
  return std::make_unique<ViewServer>(start, config, assets);
}

}  // namespace

struct OpenViewer::Parts {
  std::vector<std::uint8_t> no_page = gzip(no_page_text);
  Asset no_page_asset{"/index.html", "text/plain; charset=utf-8", no_page};
  std::unique_ptr<ViewServer> server;
  std::optional<BrowserPage> page;
};

OpenViewer::OpenViewer(ViewStart start, const ViewerArguments& arguments, std::ostream& out)
    : parts_(std::make_unique<Parts>()) {
  if (start.session.empty()) start.session = session_name();
  std::span<const Asset> assets = embedded::page();
  if (assets.empty()) assets = {&parts_->no_page_asset, 1};
  parts_->server = serve(start, arguments, assets);
  out << "viewer: " << parts_->server->url() << '\n' << std::flush;
  // Without output nobody would know the address.
  if (!out) throw std::runtime_error("cannot write to the standard output");
  if (listens_everywhere(arguments.address))
    out << "The viewer listens on every address of this machine; --name adds host names\n" << std::flush;
  if (arguments.browser) parts_->page.emplace(parts_->server->url());
}

OpenViewer::~OpenViewer() = default;

int view_command(const ViewArguments& arguments, std::ostream& out, std::ostream& err) {
  ViewStart start = start_of(arguments.what);
  const StopSignal stop;
  const OpenViewer viewer(std::move(start), arguments.viewer, out);
  if (isatty(STDERR_FILENO) == 1) err << "Ctrl-C ends it\n" << std::flush;
  stop.wait();
  return exit_done;
}

}  // namespace flexura
