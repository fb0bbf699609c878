#include "bench/query/view/html.h"

#include <fstream>
#include <stdexcept>

#include "bench/query/view/viewer_page.h"
#include "core/base/error.h"

namespace cscd::bench {
namespace {

// JSON as it may stand in a page: no text in it can end the element that it stands in.
std::string json_for_html(const nlohmann::json& value) {
  std::string out;
  for (const char letter : value.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace))
    if (letter == '<')
      out += "\\u003c";
    else
      out += letter;
  return out;
}

std::string header_element(const nlohmann::json& value) {
  return "<script type=\"application/json\" id=\"header\">" + json_for_html(value) + "</script>";
}

std::string with_data(std::string_view page, const std::string& data) {
  const std::size_t place = page.find(kDataPlace);
  if (place == std::string_view::npos) throw std::logic_error("a page has no place for data");
  return std::string(page.substr(0, place)) + data + std::string(page.substr(place + kDataPlace.size()));
}

}  // namespace

void require_viewer() {
  if (viewer_page().empty())
    throw InputError(
        "this program was built without its pages; install nodejs and npm, and build it again with "
        "-DCSCD_VIEWER=ON");
}

std::string viewer_with(std::string_view page, const nlohmann::json& header, const Sections& sections) {
  nlohmann::json whole = header;
  whole["sections"] = sections.table();
  return with_data(page, header_element(whole) +
                             "\n<script type=\"application/octet-stream\" id=\"arrays\">" +
                             base64(sections.bytes()) + "</script>");
}

bool is_page_of_viewer(const std::filesystem::path& path) {
  constexpr std::string_view kGenerator = "<meta name=\"generator\" content=\"cscd view\">";
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  std::string head(500, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  return head.starts_with("<!doctype html>") && head.find(kGenerator) != std::string::npos;
}

std::string report_with(const nlohmann::json& document) {
  require_viewer();
  return with_data(report_page(), header_element(document));
}

}  // namespace cscd::bench
