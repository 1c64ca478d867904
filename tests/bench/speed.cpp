// How fast the renderer is on the device chosen: prints a Markdown table a subject, and writes them as JSON. By hand,
// on an idle machine: tests/bench/speed, which keeps the figures in results/speed.md.

#include <cstdlib>
#include <fstream>
#include <thread>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "bench/speed.h"

using namespace vkcppm;
using namespace vkcppm::bench;

namespace {

/// A device for every number of threads. lavapipe reads LP_NUM_THREADS when a device is made.
std::vector<Worker> make_workers(const Device::Options& options, const std::vector<unsigned>& threads) {
    std::vector<Worker> workers;
    for (const unsigned count : threads) {
        setenv("LP_NUM_THREADS", std::to_string(count).c_str(), 1);
        workers.push_back({count, std::make_unique<Device>(options)});
        if (workers.back().device->policy().way != Way::cpu) {
            workers.back().threads = std::max(1u, std::thread::hardware_concurrency());
            break;
        }
    }
    return workers;
}

/// A number with three digits or as a whole one; text as it is.
std::string cell(const nlohmann::ordered_json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number_integer()) return value.dump();
    const double number = value.get<double>();
    return std::abs(number) < 1000.0 ? fmt::format("{:.3g}", number) : fmt::format("{:.0f}", number);
}

void print(const Table& table) {
    fmt::print("### {}\n\n{}\n\n|", table.name, table.caption);
    for (const std::string& column : table.columns) fmt::print(" {} |", column);
    fmt::print("\n|");
    for (std::size_t i = 0; i < table.columns.size(); ++i) fmt::print("---|");
    for (const auto& row : table.rows) {
        fmt::print("\n|");
        for (const auto& value : row) fmt::print(" {} |", cell(value));
    }
    fmt::print("\n\n");
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("How fast the renderer is: a table a subject.");
    Device::Options device;
    Bench bench;
    std::vector<unsigned> threads{1, 2};
    std::vector<std::string> only;
    std::string json_file;
    app.add_option("--device", device.select, "As vkcppm takes it");
    app.add_option("--threads", threads, "Numbers of threads of lavapipe and the host (default: 1,2)")->delimiter(',');
    app.add_option("--runs", bench.runs, "Runs of each, of which the least counts (default: 3)");
    app.add_option("--only", only, "Subjects: rays, bvh, gather, iterations, growth, instances (default: all)")
        ->delimiter(',');
    app.add_option("--scene", bench.scenes,
                   "Further scenes for `iterations`, at 256x256 and 512x512 with 65,536 paths");
    app.add_option("--json", json_file, "The figures once more");
    CLI11_PARSE(app, argc, argv);

    bench.workers = make_workers(device, threads);
    const DeviceInfo& info = bench.workers.front().device->info();
    nlohmann::ordered_json json = {{"device", info.name},
                                   {"driver", info.driver},
                                   {"runs", bench.runs},
                                   {"tables", nlohmann::ordered_json::object()}};
    fmt::print("Device: {}, {}. The least of {} runs.\n\n", info.name, info.driver, bench.runs);
    using Subject = Table (*)(const Bench&);
    for (const auto& [name, subject] : {std::pair<std::string, Subject>("rays", bench_rays),
                                        {"bvh", bench_bvh},
                                        {"gather", bench_gather},
                                        {"iterations", bench_iterations},
                                        {"growth", bench_growth},
                                        {"instances", bench_instances}}) {
        if (!only.empty() && std::ranges::find(only, name) == only.end()) continue;
        const Table table = subject(bench);
        print(table);
        json["tables"][name] = {{"caption", table.caption}, {"columns", table.columns}, {"rows", table.rows}};
    }
    if (!json_file.empty()) std::ofstream(json_file) << json.dump(1) << "\n";
}
