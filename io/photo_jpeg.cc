#include "ibrdf/io/photo_jpeg.h"

// jpeglib.h needs FILE and size_t.
#include <cstdio>
// After it.
#include <jpeglib.h>
// After both.
#include <jerror.h>

#include <csetjmp>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "ibrdf/io/exif.h"
#include "ibrdf/io/icc_profile.h"

namespace ibrdf {
namespace {

constexpr int kMaxScans = 100;
constexpr int kExifMarker = JPEG_APP0 + 1;
constexpr int kIccMarker = JPEG_APP0 + 2;
constexpr unsigned int kMaxMarkerBytes = 0xFFFF;

// libjpeg's errors leave by longjmp: functions that call setjmp own nothing,
// they work on the state of a caller.
struct JpegState {
  jpeg_error_mgr errors;  // first: libjpeg hands a pointer to it back
  jmp_buf jump;
  int code = 0;  // of the error
  char message[JMSG_LENGTH_MAX] = "";
  jpeg_progress_mgr progress;
  jpeg_decompress_struct jpeg;
  JOCTET* icc = nullptr;  // of malloc
  unsigned int icc_bytes = 0;
  std::vector<uint8_t> row;
  std::vector<float> values;  // [rows, width, channels]

  JpegState() : errors(), progress(), jpeg() {}
  ~JpegState() {
    jpeg_destroy_decompress(&jpeg);
    std::free(icc);
  }
  JpegState(const JpegState&) = delete;
  JpegState& operator=(const JpegState&) = delete;
};

JpegState* StateOf(j_common_ptr jpeg) {
  return reinterpret_cast<JpegState*>(jpeg->err);
}

void OnJpegError(j_common_ptr jpeg) {
  JpegState* state = StateOf(jpeg);
  state->code = jpeg->err->msg_code;
  jpeg->err->format_message(jpeg, state->message);
  std::longjmp(state->jump, 1);
}

// Warnings (level -1) say that libjpeg mends what is damaged.
void OnMessage(j_common_ptr jpeg, int level) {
  if (level >= 0) return;
  switch (jpeg->err->msg_code) {
    case JWRN_EXTRANEOUS_DATA:  // bytes between markers, which cameras leave
    case JWRN_JFIF_MAJOR:
    case JWRN_ADOBE_XFORM:
    case JWRN_BOGUS_ICC:
      return;
    default:
      OnJpegError(jpeg);
  }
}

void OnProgress(j_common_ptr jpeg) {
  if (reinterpret_cast<j_decompress_ptr>(jpeg)->input_scan_number <=
      kMaxScans) {
    return;
  }
  JpegState* state = StateOf(jpeg);
  std::snprintf(state->message, sizeof(state->message), "more than %d scans",
                kMaxScans);
  std::longjmp(state->jump, 1);
}

bool ReadJpegHeader(const std::string& bytes, JpegState* state) {
  state->jpeg.err = jpeg_std_error(&state->errors);
  state->errors.error_exit = OnJpegError;
  state->errors.emit_message = OnMessage;
  if (setjmp(state->jump) != 0) return false;
  jpeg_create_decompress(&state->jpeg);
  state->progress.progress_monitor = OnProgress;
  state->jpeg.progress = &state->progress;
  jpeg_mem_src(&state->jpeg,
               reinterpret_cast<const unsigned char*>(bytes.data()),
               static_cast<unsigned long>(bytes.size()));
  jpeg_save_markers(&state->jpeg, kExifMarker, kMaxMarkerBytes);
  jpeg_save_markers(&state->jpeg, kIccMarker, kMaxMarkerBytes);
  jpeg_read_header(&state->jpeg, TRUE);
  jpeg_read_icc_profile(&state->jpeg, &state->icc, &state->icc_bytes);
  return true;
}

// `values` has the capacity of all of them and grows by rows.
bool ReadJpegRows(JpegState* state) {
  if (setjmp(state->jump) != 0) return false;
  jpeg_start_decompress(&state->jpeg);
  while (state->jpeg.output_scanline < state->jpeg.output_height) {
    JSAMPROW row = state->row.data();
    jpeg_read_scanlines(&state->jpeg, &row, 1);
    state->values.insert(state->values.end(), state->row.begin(),
                         state->row.end());
  }
  jpeg_finish_decompress(&state->jpeg);
  return true;
}

Status JpegError(const std::string& path, const JpegState& state) {
  switch (state.code) {
    case JERR_BAD_PRECISION:
      return InvalidInput(path + ": bits",
                          "expected 8 bits, found " +
                              std::to_string(state.jpeg.data_precision) +
                              "; save it as PNG or TIFF of "
                              "16 bits");
    case JERR_CONVERSION_NOTIMPL:
      return InvalidInput(path + ": colours", "expected grey or RGB");
    default:
      return InvalidInput(path, std::string("expected a whole JPEG image (") +
                                    state.message + ")");
  }
}

// Grey or RGB out of grey, YCbCr or RGB.
Status ChooseColours(const std::string& path, jpeg_decompress_struct* jpeg) {
  switch (jpeg->jpeg_color_space) {
    case JCS_GRAYSCALE:
      jpeg->out_color_space = JCS_GRAYSCALE;
      return OkStatus();
    case JCS_YCbCr:
    case JCS_RGB:
      jpeg->out_color_space = JCS_RGB;
      return OkStatus();
    case JCS_CMYK:
    case JCS_YCCK:
      return InvalidInput(path + ": colours",
                          "expected grey or RGB, found CMYK, the inks of a "
                          "print; convert it to sRGB");
    default:
      return InvalidInput(path + ": colours",
                          "expected grey or RGB, found " +
                              std::to_string(jpeg->num_components) +
                              " channels of an unknown kind");
  }
}

void ReadJpegTags(const JpegState& state, Photo* photo) {
  if (state.icc != nullptr) {
    photo->tags.icc = ParseIccProfile(
        {reinterpret_cast<const char*>(state.icc), state.icc_bytes});
  }
  if (state.jpeg.saw_JFIF_marker && state.jpeg.X_density > 0 &&
      state.jpeg.Y_density > 0) {
    photo->pixel_aspect =
        static_cast<double>(state.jpeg.Y_density) / state.jpeg.X_density;
  }
  constexpr std::string_view kExif("Exif\0\0", 6);
  for (jpeg_saved_marker_ptr marker = state.jpeg.marker_list; marker != nullptr;
       marker = marker->next) {
    const std::string_view data(reinterpret_cast<const char*>(marker->data),
                                marker->data_length);
    if (marker->marker != kExifMarker ||
        data.substr(0, kExif.size()) != kExif) {
      continue;
    }
    AddExif(ParseExif(data.substr(kExif.size())), photo);
    return;
  }
}

}  // namespace

StatusOr<Photo> DecodeJpegPhoto(const std::string& path,
                                const std::string& bytes,
                                const PhotoOptions& options) {
  JpegState state;
  if (!ReadJpegHeader(bytes, &state)) return JpegError(path, state);
  IBRDF_RETURN_IF_ERROR(CheckImageSize(
      path, state.jpeg.image_width, state.jpeg.image_height, options.limits));
  IBRDF_RETURN_IF_ERROR(ChooseColours(path, &state.jpeg));
  Photo photo;
  photo.format = PhotoFormat::kJpeg;
  photo.bits = photo.significant_bits = 8;
  photo.grey = state.jpeg.out_color_space == JCS_GRAYSCALE;
  ReadJpegTags(state, &photo);  // before the end of decompression frees them

  const size_t width = state.jpeg.image_width;
  const size_t pixels = width * state.jpeg.image_height;
  state.row.resize(width * (photo.grey ? 1 : 3));
  state.values.reserve(pixels * (photo.grey ? 1 : 3));
  if (!ReadJpegRows(&state)) return JpegError(path, state);
  photo.image.width = static_cast<int>(width);
  photo.image.height = static_cast<int>(state.jpeg.image_height);
  if (!photo.grey) {
    photo.image.rgb = std::move(state.values);
    return photo;
  }
  photo.image.rgb.reserve(3 * pixels);
  for (const float value : state.values) {
    photo.image.rgb.insert(photo.image.rgb.end(), 3, value);
  }
  return photo;
}

}  // namespace ibrdf
