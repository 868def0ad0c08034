#include <csetjmp>
#include <string>

#include <png.h>

#include "apps/preview/image.h"
#include "core/base/atomic_file.h"
#include "core/base/error.h"

namespace toile::preview {

namespace {

void append_bytes(png_structp png, png_bytep bytes, size_t count)
{
    static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(bytes), count);
}

void flush_nothing(png_structp) {}

/// Encodes into `content`; false if libpng failed. libpng exits by longjmp, so no local variable here has a
/// destructor.
bool encode_png(const Image& image, std::string& content)
{
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    if (!png)
        return false;
    png_infop info = png_create_info_struct(png);
    if (!info || setjmp(png_jmpbuf(png))) {
        png_destroy_write_struct(&png, &info);
        return false;
    }
    png_set_write_fn(png, &content, append_bytes, flush_nothing);
    png_set_IHDR(png, info, png_uint_32(image.width), png_uint_32(image.height), 8, PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(png, info);
    for (int y = 0; y < image.height; ++y)
        png_write_row(png, image.pixel(0, y));
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return true;
}

} // namespace

void write_png(const std::filesystem::path& file, const Image& image)
{
    if (image.width < 1 || image.height < 1)
        throw InvalidInput(file.string() + ": the picture is " + std::to_string(image.width) + " x " +
                           std::to_string(image.height) + " pixels; it needs 1 x 1 or more");
    std::string content;
    if (!encode_png(image, content))
        throw DeviceError(file.string() + ": the PNG encoder ran out of memory");
    write_atomically(file, content);
}

} // namespace toile::preview
