#include "manual.h"

#include "arguments.h"

#include <fmt/core.h>

namespace octafront::cli {

namespace {

/// As text, not as requests of troff.
std::string plain(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool begins_line = i == 0 || text[i - 1] == '\n';
    if (begins_line && (text[i] == '.' || text[i] == '\'')) out += "\\&";
    if (text[i] == '\\') {
      out += "\\e";
    } else if (text[i] == '-') {
      out += "\\-";
    } else {
      out += text[i];
    }
  }
  return out;
}

/// \fB-o\fR, \fB--output\fR \fIFILE\fR
std::string term_of(const CLI::Option& option) {
  std::string term;
  const auto add = [&](const std::string& name) { term += (term.empty() ? "\\fB" : ", \\fB") + plain(name) + "\\fR"; };
  for (const std::string& name : option.get_snames()) add("-" + name);
  for (const std::string& name : option.get_lnames()) add("--" + name);
  const std::string value = option.get_items_expected_max() == 0 ? "" : option.get_type_name();
  if (term.empty()) return "\\fI" + plain(value.empty() ? option.get_name() : value) + "\\fR";
  return value.empty() ? term : term + " \\fI" + plain(value) + "\\fR";
}

std::string options_in(const CLI::App& group) {
  std::string text;
  const bool is_command = !group.get_name().empty();
  for (const CLI::Option* option : group.get_options())
    if (is_command || option != group.get_help_ptr())
      text += ".TP\n" + term_of(*option) + "\n" + plain(option->get_description()) + "\n";
  for (const CLI::App* inner : group.get_subcommands([](const CLI::App*) { return true; })) {
    if (!inner->get_name().empty()) continue;
    text += fmt::format(".PP\n\\fI{}\\fR{}\n", plain(inner->get_group()),
                        inner->get_description().empty() ? "" : ": " + plain(inner->get_description()));
    text += options_in(*inner);
  }
  return text;
}

std::string section_of(const CLI::App& command) {
  std::string text =
      fmt::format(".SS \"octafront {}\"\n{}\n", plain(command.get_name()), plain(command.get_description()));
  text += options_in(command);
  if (!command.get_footer().empty()) text += ".PP\n.nf\n" + plain(command.get_footer()) + ".fi\n";
  return text;
}

}  // namespace

std::string manual_page(const CLI::App& app) {
  std::string text = ".TH OCTAFRONT 1 \"\" \"octafront " OCTAFRONT_VERSION "\" \"User Commands\"\n";
  text += ".SH NAME\noctafront \\- tetrahedral finite element meshes from closed surfaces\n";
  text += ".SH SYNOPSIS\n.B octafront\n\\fICOMMAND\\fR [\\fIOPTION\\fR ...]\n";
  text +=
      ".SH DESCRIPTION\nMakes tetrahedral meshes of closed surfaces: an octree carries the element sizes, an advancing "
      "front triangulates the surface anew, a second one fills the volume, and smoothing and reconnection finish the "
      "elements. Every mesh is checked before it is written. The same input gives the same mesh, bit for bit, on any "
      "number of threads.\n";
  text += ".SH COMMANDS\n";
  for (const CLI::App* command : commands_of(app)) text += section_of(*command);
  text +=
      ".SH EXIT STATUS\n.TP\n0\ndone\n.TP\n2\nwrong usage\n.TP\n3\nthe input was refused\n.TP\n4\nno valid mesh\n"
      ".TP\n5\nthe output could not be written\n.TP\n6\nout of memory\n.TP\n7\na limit that was set is "
      "reached\n.TP\n130\ninterrupted, by Ctrl-C, TERM or a "
      "hang-up\n.TP\n1\na bug of ours\n";
  text += ".SH ENVIRONMENT\n.TP\nTMPDIR\nwhere a mesh waits that goes to standard output\n";
  text += ".SH SEE ALSO\n\\fBoctafront help\\fR \\fICOMMAND\\fR; the documentation that comes with the program.\n";
  return text;
}

}  // namespace octafront::cli
