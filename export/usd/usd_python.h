#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace toile::exports {

/// A new folder for files that pass between programs; removed with all that is in it.
class ExchangeFolder {
public:
    /// @throws DeviceError if the system refuses
    ExchangeFolder();
    ~ExchangeFolder();
    ExchangeFolder(const ExchangeFolder&) = delete;
    ExchangeFolder& operator=(const ExchangeFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

/// Runs a command of usd_commands.py in python3, or the interpreter that the environment variable
/// TOILE_PYTHON names.
/// @param file       that it is about, for errors
/// @param arguments  the command and its arguments
/// @return what it prints
/// @throws InvalidInput  if it refuses the file, or where there is no Python with USD
/// @throws DeviceError   if it breaks off
std::string run_usd_command(const std::filesystem::path& file, const std::vector<std::string>& arguments,
                            const ExchangeFolder& folder);

/// @throws InvalidInput where there is no Python with USD
void require_usd_python(const std::filesystem::path& file);

} // namespace toile::exports
