#include <csetjmp>
#include <cstdio> // jpeglib.h needs it

#include <jpeglib.h>

#include <jerror.h>

#include "apps/preview/paint/decode_image.h"

namespace toile::preview {

namespace {

/// What libjpeg reports to.
struct Errors {
    jpeg_error_mgr manager; ///< first: libjpeg knows only this
    std::jmp_buf stop;
    std::string* error;
};

[[noreturn]] void stop(j_common_ptr common)
{
    char message[JMSG_LENGTH_MAX];
    common->err->format_message(common, message);
    auto* errors = reinterpret_cast<Errors*>(common->err);
    *errors->error = message;
    std::longjmp(errors->stop, 1);
}

/// Most warnings leave a whole image; a cut-off one is none.
void note(j_common_ptr common, int level)
{
    if (level < 0 && (common->err->msg_code == JWRN_JPEG_EOF || common->err->msg_code == JWRN_HIT_MARKER))
        stop(common);
}

void read_rows(jpeg_decompress_struct& jpeg, DecodedImage& image)
{
    image.width = int(jpeg.output_width);
    image.height = int(jpeg.output_height);
    image.rgba.resize(4 * size_t(image.width) * size_t(image.height));
    while (jpeg.output_scanline < jpeg.output_height) {
        JSAMPROW row = &image.rgba[4 * size_t(jpeg.output_scanline) * size_t(image.width)];
        jpeg_read_scanlines(&jpeg, &row, 1);
    }
}

} // namespace

/// libjpeg exits by longjmp, so what has a destructor is the caller's.
void decode_jpeg(std::span<const unsigned char> bytes, DecodedImage& image, std::string& error)
{
    Errors errors{};
    errors.error = &error;
    jpeg_decompress_struct jpeg{};
    jpeg.err = jpeg_std_error(&errors.manager);
    jpeg.err->error_exit = stop;
    jpeg.err->emit_message = note;
    if (setjmp(errors.stop)) {
        jpeg_destroy_decompress(&jpeg);
        return;
    }
    jpeg_create_decompress(&jpeg);
    jpeg_mem_src(&jpeg, bytes.data(), bytes.size());
    jpeg_read_header(&jpeg, TRUE);
    error = size_error(jpeg.image_width, jpeg.image_height);
    if (error.empty()) {
        jpeg.out_color_space = JCS_EXT_RGBA;
        jpeg_start_decompress(&jpeg);
        read_rows(jpeg, image);
        jpeg_finish_decompress(&jpeg);
    }
    jpeg_destroy_decompress(&jpeg);
}

} // namespace toile::preview
