#include "bench/view/html.h"

#include <stdexcept>

#include "bench/view/viewer_page.h"
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

}  // namespace

void require_viewer() {
  if (viewer_page().empty())
    throw InputError(
        "this program was built without its viewer; install nodejs and npm, and build it again with "
        "-DCSCD_VIEWER=ON");
}

std::string viewer_with(const nlohmann::json& header, const Sections& sections) {
  require_viewer();
  const std::string_view page = viewer_page();
  const std::size_t place = page.find(kDataPlace);
  if (place == std::string_view::npos) throw std::logic_error("the viewer's page has no place for data");
  nlohmann::json whole = header;
  whole["sections"] = sections.table();
  std::string out(page.substr(0, place));
  out += "<script type=\"application/json\" id=\"header\">" + json_for_html(whole) + "</script>\n";
  out += "<script type=\"application/octet-stream\" id=\"arrays\">" + base64(sections.bytes()) + "</script>";
  out += page.substr(place + kDataPlace.size());
  return out;
}

}  // namespace cscd::bench
