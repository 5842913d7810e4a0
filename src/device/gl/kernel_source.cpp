// SPDX-License-Identifier: MIT
// GLSL has no #include of its own, so files are spliced in here, each once. The origin of each line is kept in a table
// and looked up in the driver's messages. #line directives were tried first, but Mesa reports most errors without the
// number of the file.
#include "device/gl/kernel_source.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <regex>
#include <sstream>
#include <utility>

#include <talus/types.h>

#include "device/gl/record_cells.h"

namespace talus::engine {
namespace {

constexpr std::string_view k_kernel_ending = ".comp.glsl";

/// Empty where TALUS_KERNEL_PATH is not set.
std::filesystem::path kernel_folder() {
    const char* folder = std::getenv("TALUS_KERNEL_PATH");
    return folder != nullptr ? folder : "";
}

std::string shader_text(const std::string& path, std::string_view wanted_by) {
    const std::filesystem::path folder = kernel_folder();
    if (!folder.empty()) {
        if (std::ifstream file(folder / path, std::ios::binary); file) {
            std::ostringstream text;
            text << file.rdbuf();
            return std::move(text).str();
        }
    }
    for (const ShaderFile& file : embedded_files()) {
        if (file.path == path) return std::string(file.text);
    }
    std::string message = "no shader file '" + path + "', wanted by " + std::string(wanted_by) +
                          ": it is neither embedded in the library";
    message += folder.empty() ? std::string(", and TALUS_KERNEL_PATH names no folder to look in")
                              : " nor below TALUS_KERNEL_PATH (" + folder.string() + ")";
    throw Error(message);
}

/// The path in quotes where the line is an #include directive, otherwise nothing.
std::string_view included_path(std::string_view line) {
    const auto skip_spaces = [&line] { line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size())); };
    skip_spaces();
    for (const std::string_view token : {std::string_view("#"), std::string_view("include"), std::string_view("\"")}) {
        if (!line.starts_with(token)) return {};
        line.remove_prefix(token.size());
        skip_spaces();
    }
    return line.substr(0, line.find('"'));
}

struct Assembly {
    KernelSource source;

    void add_line(std::string_view line, std::size_t file, std::size_t number) {
        source.text.append(line).push_back('\n');
        source.lines.push_back({file, number});
    }

    void add_text(const std::string& name, std::string_view text) {
        const std::size_t file = source.files.size();
        source.files.push_back(name);
        std::size_t number = 0;
        while (!text.empty()) {
            const std::string_view line = text.substr(0, text.find('\n'));
            text.remove_prefix(std::min(line.size() + 1, text.size()));
            ++number;
            if (const std::string_view included = included_path(line); !included.empty())
                add_file(std::string(included), name + ":" + std::to_string(number));
            else
                add_line(line, file, number);
        }
    }

    void add_file(const std::string& path, std::string_view wanted_by) {
        if (std::find(source.files.begin(), source.files.end(), path) == source.files.end())
            add_text(path, shader_text(path, wanted_by));
    }
};

/// cells_for() the kernel. Those of all records are only made again where another folder of kernels has brought another
/// text.
std::string cells_of_records(std::string_view kernel) {
    static std::mutex mutex;
    static std::string records;
    static std::vector<RecordCells> cells;
    std::string text = shader_text("state/records.shared.glsl", "every kernel");
    const std::lock_guard lock(mutex);
    if (text != records) {
        cells = record_cells(text);
        records = std::move(text);
    }
    return cells_for(kernel, cells);
}

} // namespace

std::vector<std::string> kernel_paths() {
    std::vector<std::string> paths;
    for (const ShaderFile& file : embedded_files()) {
        if (file.path.ends_with(k_kernel_ending))
            paths.emplace_back(file.path.substr(0, file.path.size() - k_kernel_ending.size()));
    }
    return paths;
}

void check_kernel_folder() {
    const std::filesystem::path folder = kernel_folder();
    if (folder.empty()) return;
    std::error_code ignored;
    if (!std::filesystem::is_directory(folder, ignored))
        throw Error("TALUS_KERNEL_PATH is '" + folder.string() +
                    "', and there is no such folder; it must name the folder src of Talus's sources, or one like it");
    const auto is_there = [&](const ShaderFile& file) { return std::filesystem::exists(folder / file.path, ignored); };
    if (std::ranges::none_of(embedded_files(), is_there))
        throw Error("TALUS_KERNEL_PATH is '" + folder.string() + "', which holds no shader of Talus; below it there " +
                    "must be files such as " + std::string(embedded_files().front().path));
}

KernelSource kernel_source(std::string_view path, const KernelTarget& target) {
    const std::string file = std::string(path) + std::string(k_kernel_ending);
    Assembly alone;
    alone.add_file(file, "the step");
    Assembly assembly;
    assembly.add_text(
        "head of every kernel",
        "#version 450 core\nconst bool k_waits_freely = " + std::string(target.waits_freely ? "true" : "false") +
            ";\nconst uint k_in_step = " + std::to_string(target.in_step) + "u;\n");
    for (const char* shared : {"device/gl/dialect.glsl", "state/constants.shared.glsl", "state/records.shared.glsl"})
        assembly.add_file(shared, "every kernel");
    assembly.add_text("cells of the records", cells_of_records(alone.source.text));
    assembly.add_text("parameters of every kernel",
                      "layout(std140) uniform ParametersBlock { Parameters parameters; };\n");
    assembly.add_file(file, "the step");
    return std::move(assembly.source);
}

std::string trace_log(std::string_view log, const KernelSource& source) {
    // Mesa "0:12(5): error", NVIDIA "0(12) : error", others "ERROR: 0:12: ".
    static const std::regex place(R"(^(ERROR: )?0(?::(\d{1,6})(?:\((\d+)\))?|\((\d{1,6})\))\s*:\s*)");
    std::ostringstream traced;
    std::istringstream lines{std::string(log)};
    for (std::string line; std::getline(lines, line);) {
        std::smatch match;
        if (std::regex_search(line, match, place)) {
            const std::size_t number = std::stoul((match[2].matched ? match[2] : match[4]).str());
            if (number >= 1 && number <= source.lines.size()) {
                const KernelSource::Origin origin = source.lines[number - 1];
                traced << source.files[origin.file] << ':' << origin.line << ':';
                if (match[3].matched) traced << match[3] << ':';
                traced << ' ' << match[1] << match.suffix() << '\n';
                continue;
            }
        }
        if (!line.empty() && line.front() != '\0') traced << line << '\n';
    }
    return traced.str();
}

} // namespace talus::engine
