//! The moments of a run one after the other: animated PNG, or a video through ffmpeg.

use std::io::Write;
use std::path::Path;
use std::process::{Child, Command, Stdio};

use super::error::ViewError;
use super::film::Film;
use super::image::{Look, Picture};

/// Formats of animations.
pub const ENDINGS: &str = ".png or .apng (animated PNG), .webm or .mp4 (through ffmpeg)";

/// A file that takes one picture after the other.
trait Sink {
    /// Takes the pixels of a picture, four bytes each.
    fn push(&mut self, rgba: &[u8]) -> Result<(), ViewError>;
    /// Ends the file; its bytes, if they are still to be written.
    fn finish(self: Box<Self>) -> Result<Option<Vec<u8>>, ViewError>;
}

/// Writes the moments of a film as an animation of so many pictures a second; all look alike but for the blocks and the time.
///
/// # Errors
/// [`ViewError::Ending`] for another ending than [`ENDINGS`]; otherwise as for a picture.
pub fn write(film: &Film, look: Look, per_second: u16, path: &Path) -> Result<(), ViewError> {
    let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or("");
    let mut sink: Box<dyn Sink> = match ending {
        "png" | "apng" => Box::new(Apng::new(film.moments.len(), look.size, per_second, path)),
        "webm" | "mp4" => Box::new(Video::start(look.size, per_second, path)?),
        _ => {
            return Err(ViewError::Ending {
                path: path.to_path_buf(),
                what: "an animation",
                endings: ENDINGS,
            });
        }
    };
    let picture = Picture::new(film, look);
    let stage = picture.stage(1);
    for moment in &film.moments {
        let rgba = picture
            .rgba(&stage, moment)
            .map_err(|reason| ViewError::Encode { path: path.to_path_buf(), reason })?;
        sink.push(&rgba)?;
    }
    match sink.finish()? {
        Some(bytes) => Ok(ndda_io::atomic::write_named(path, &bytes)?),
        None => Ok(()),
    }
}

/// An animated PNG: of each picture but the first, only the pixels that have changed.
struct Apng<'a> {
    path: &'a Path,
    file: std::sync::Arc<std::sync::Mutex<Vec<u8>>>,
    writer: Option<png::Writer<Shared>>,
    count: usize,
    size: (u32, u32),
    per_second: u16,
    before: Vec<u8>,
}

/// Bytes that outlive the writer of a PNG.
#[derive(Clone)]
struct Shared(std::sync::Arc<std::sync::Mutex<Vec<u8>>>);

impl Write for Shared {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.lock().map_err(|_| std::io::Error::other("a writer has failed"))?.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

impl<'a> Apng<'a> {
    fn new(count: usize, size: (u32, u32), per_second: u16, path: &'a Path) -> Self {
        Self { path, file: Default::default(), writer: None, count, size, per_second, before: Vec::new() }
    }

    fn begin(&self) -> Result<png::Writer<Shared>, png::EncodingError> {
        let mut encoder = png::Encoder::new(Shared(self.file.clone()), self.size.0, self.size.1);
        encoder.set_color(png::ColorType::Rgba);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_animated(self.count as u32, 0)?;
        encoder.set_frame_delay(1, self.per_second)?;
        encoder.set_blend_op(png::BlendOp::Over)?;
        encoder.write_header()
    }

    fn encoded(&self, error: png::EncodingError) -> ViewError {
        ViewError::Encode { path: self.path.to_path_buf(), reason: error.to_string() }
    }
}

impl Sink for Apng<'_> {
    fn push(&mut self, rgba: &[u8]) -> Result<(), ViewError> {
        if self.writer.is_none() {
            self.writer = Some(self.begin().map_err(|e| self.encoded(e))?);
        }
        let changed = changed(&self.before, rgba);
        self.before = rgba.to_vec();
        let written = self.writer.as_mut().map(|writer| writer.write_image_data(&changed));
        written.unwrap_or(Ok(())).map_err(|e| self.encoded(e))
    }

    fn finish(mut self: Box<Self>) -> Result<Option<Vec<u8>>, ViewError> {
        if let Some(writer) = self.writer.take() {
            writer.finish().map_err(|e| self.encoded(e))?;
        }
        let bytes = self.file.lock().map(|mut bytes| std::mem::take(&mut *bytes));
        Ok(bytes.ok())
    }
}

/// Pixels with those that are as before made transparent.
fn changed(before: &[u8], now: &[u8]) -> Vec<u8> {
    if before.len() != now.len() {
        return now.to_vec();
    }
    let pixels = before.chunks_exact(4).zip(now.chunks_exact(4));
    pixels.flat_map(|(a, b)| if a == b { [0; 4] } else { [b[0], b[1], b[2], b[3]] }).collect()
}

/// ffmpeg, which reads pixels and writes a video.
struct Video<'a> {
    path: &'a Path,
    child: Child,
}

impl<'a> Video<'a> {
    fn start((width, height): (u32, u32), per_second: u16, path: &'a Path) -> Result<Self, ViewError> {
        let mut command = Command::new("ffmpeg");
        command.args(["-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgba"]);
        command.args(["-s", &format!("{width}x{height}"), "-r", &per_second.to_string(), "-i", "-"]);
        // Colours of videos go in pairs of pixels.
        command.args(["-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p"]);
        if path.extension().is_some_and(|ending| ending == "webm") {
            command.args(["-c:v", "libvpx-vp9", "-crf", "30", "-b:v", "0"]);
        }
        command.arg(path).stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
        let child = command.spawn().map_err(|error| failed(path, &format!("cannot be started: {error}")))?;
        Ok(Self { path, child })
    }
}

impl Sink for Video<'_> {
    fn push(&mut self, rgba: &[u8]) -> Result<(), ViewError> {
        // A pipe that ffmpeg has closed is told by its own message at the end.
        let taken = self.child.stdin.as_mut().map(|pipe| pipe.write_all(rgba));
        match taken {
            Some(Err(error)) if error.kind() != std::io::ErrorKind::BrokenPipe => {
                Err(failed(self.path, &format!("takes no pictures: {error}")))
            }
            _ => Ok(()),
        }
    }

    fn finish(self: Box<Self>) -> Result<Option<Vec<u8>>, ViewError> {
        let path = self.path;
        let output = self.child.wait_with_output().map_err(|error| failed(path, &error.to_string()))?;
        if output.status.success() {
            return Ok(None);
        }
        let said = String::from_utf8_lossy(&output.stderr);
        Err(failed(path, &format!("ended with {}: {}", output.status, said.lines().last().unwrap_or(""))))
    }
}

fn failed(path: &Path, reason: &str) -> ViewError {
    ViewError::Ffmpeg { path: path.to_path_buf(), reason: reason.into() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view3d::bolts::BoltColour;
    use crate::view3d::stage::Resting;
    use crate::view3d::testing::boxes;

    /// A box that moves by a metre in so many moments.
    fn film(moments: usize) -> Film {
        let mut film =
            boxes(&[([0.0; 3], [1.0; 3], [1.0, 0.0, 0.0]), ([0.0, 0.0, -1.0], [3.0, 1.0, 1.0], [0.0; 3])]);
        let last = film.moments[0].clone();
        film.moments = (0..moments)
            .map(|i| {
                let part = i as f64 / (moments - 1).max(1) as f64;
                let mut moment = last.clone();
                moment.time_s = Some(part);
                for (x, x0) in moment.positions.iter_mut().zip(&film.start) {
                    *x = x0 + part * (*x - x0);
                }
                moment
            })
            .collect();
        film
    }

    fn look() -> Look {
        Look {
            view: "front".parse().unwrap(),
            resting: Resting::Solid,
            whole: true,
            magnify: 1.0,
            outlines: false,
            bolts: BoltColour::Force,
            dark: false,
            size: (240, 180),
        }
    }

    #[test]
    fn an_animated_png_has_a_frame_per_moment_and_each_is_the_picture_of_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        for moments in [1, 2, 7] {
            let film = film(moments);
            write(&film, look(), 10, &path).unwrap();
            let file = std::io::BufReader::new(std::fs::File::open(&path).unwrap());
            let mut reader = png::Decoder::new(file).read_info().unwrap();
            assert_eq!(reader.info().animation_control.unwrap().num_frames, moments as u32);
            let picture = Picture::new(&film, look());
            let stage = picture.stage(1);
            let mut shown = vec![0; reader.output_buffer_size().unwrap()];
            for moment in &film.moments {
                let mut frame = vec![0; shown.len()];
                reader.next_frame(&mut frame).unwrap();
                // A transparent pixel leaves what was there.
                for (to, from) in
                    shown.chunks_exact_mut(4).zip(frame.chunks_exact(4)).filter(|(_, f)| f[3] > 0)
                {
                    to.copy_from_slice(from);
                }
                assert_eq!(shown, picture.rgba(&stage, moment).unwrap());
            }
        }
    }

    #[test]
    fn other_endings_are_refused_with_those_that_there_are() {
        let error = write(&film(2), look(), 10, Path::new("a.bmp")).unwrap_err().to_string();
        assert!(error.contains(".webm or .mp4"), "{error}");
    }

    #[test]
    fn only_pixels_that_change_are_written_again() {
        let (before, now) = ([1, 2, 3, 255, 4, 5, 6, 255], [1, 2, 3, 255, 4, 9, 6, 255]);
        assert_eq!(changed(&before, &now), [0, 0, 0, 0, 4, 9, 6, 255]);
        assert_eq!(changed(&[], &now), now);
    }
}
