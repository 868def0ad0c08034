#include <algorithm>
#include <csetjmp>
#include <cstring>

#include <png.h>

#include "apps/preview/paint/decode_image.h"

namespace toile::preview {

namespace {

void read_bytes(png_structp png, png_bytep to, size_t count)
{
    auto& left = *static_cast<std::span<const unsigned char>*>(png_get_io_ptr(png));
    if (count > left.size())
        png_error(png, "it is cut off");
    std::memcpy(to, left.data(), count);
    left = left.subspan(count);
}

[[noreturn]] void stop(png_structp png, png_const_charp what)
{
    *static_cast<std::string*>(png_get_error_ptr(png)) = what;
    png_longjmp(png, 1);
}

void ignore(png_structp, png_const_charp) {}

/// 8 bits per channel, with alpha; no colour is changed.
void expand_to_rgba(png_structp png)
{
    png_set_expand(png);
    png_set_scale_16(png);
    png_set_gray_to_rgb(png);
    png_set_add_alpha(png, 0xff, PNG_FILLER_AFTER);
}

} // namespace

/// libpng exits by longjmp, so what has a destructor is the caller's.
void decode_png(std::span<const unsigned char> bytes, DecodedImage& image, std::string& error)
{
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &error, stop, ignore);
    png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
    if (info == nullptr || setjmp(png_jmpbuf(png))) {
        if (info == nullptr)
            error = "there is not enough memory";
        png_destroy_read_struct(&png, &info, nullptr);
        return;
    }
    png_set_read_fn(png, &bytes, read_bytes);
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX); // size_error() bounds the product
    png_read_info(png, info);
    const png_uint_32 width = png_get_image_width(png, info), height = png_get_image_height(png, info);
    error = size_error(width, height);
    if (error.empty()) {
        expand_to_rgba(png);
        const int passes = png_set_interlace_handling(png);
        png_read_update_info(png, info);
        image.width = int(width);
        image.height = int(height);
        image.rgba.resize(4 * size_t(width) * size_t(height));
        for (int pass = 0; pass < passes; ++pass)
            for (size_t y = 0; y < height; ++y)
                png_read_row(png, &image.rgba[4 * y * width], nullptr);
        png_read_end(png, nullptr);
    }
    png_destroy_read_struct(&png, &info, nullptr);
}

} // namespace toile::preview
