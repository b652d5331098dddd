//! Text of a deck file, read up to the first NUL byte or overlong line.

use super::lines::overlong;
use crate::diagnostics::{Code, Diagnostic, FileId, Span};
use crate::system::without_waiting;
use memchr::{memchr, memrchr};
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

/// Longest line, in bytes.
pub(super) const LONGEST_LINE: usize = 1 << 16;

/// Number of bytes that are read and checked at a time.
const PIECE: u64 = 1 << 20;

/// The error for a fifo, a device or a file of the system that stands in place of a regular file.
pub fn not_regular() -> io::Error {
    io::Error::other("it is not a regular file")
}

/// Opens a regular file to read it. Neither opening nor reading can block: a fifo, which would wait for its writer, is
/// refused. A file that the system creates as it is read (its size is zero) is also refused, because reading might wait
/// for an event.
///
/// # Errors
/// The file does not exist, may not be read, or is not a regular file.
pub fn open_regular(path: &Path) -> io::Result<File> {
    let data = fs::metadata(path)?;
    if data.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    if !data.is_file() {
        return Err(not_regular());
    }
    let mut file = without_waiting(File::options().read(true)).open(path)?;
    let data = file.metadata()?;
    let is_made_up = data.len() == 0 && !matches!(file.read(&mut [0]), Ok(0));
    match data.is_file() && !is_made_up {
        true => Ok(file),
        false => Err(not_regular()),
    }
}

/// Text of a file.
pub(super) struct Content {
    /// The text, up to the first fault if the file has a fault.
    pub text: String,
    /// The byte at the fault: a NUL byte, or a byte of a line that is longer than [`LONGEST_LINE`], ends the text.
    fault: Option<u8>,
}

impl Content {
    /// Reads a regular file; stops at the first fault, so the length of the file does not matter.
    pub fn of(path: &Path) -> io::Result<Content> {
        Content::read(open_regular(path)?)
    }

    /// Content given as text.
    pub fn new(text: &str) -> Content {
        // Reading from memory cannot fail.
        Content::read(text.as_bytes()).unwrap_or(Content {
            text: String::new(),
            fault: None,
        })
    }

    /// Reads to the end or to the first fault.
    fn read(mut input: impl Read) -> io::Result<Content> {
        let (mut bytes, mut fault, mut line) = (Vec::new(), None, 0);
        while fault.is_none() && input.by_ref().take(PIECE).read_to_end(&mut bytes)? > 0 {
            // the piece, from the start of the line that it continues
            let piece = bytes.get(line..).unwrap_or_default();
            let nul = memchr(0, piece);
            let sound = piece.get(..nul.unwrap_or(piece.len())).unwrap_or_default();
            if let Some(at) = overlong(sound, LONGEST_LINE).or(nul) {
                fault = piece.get(at).copied();
                bytes.truncate(line + at);
            }
            line = memrchr(b'\n', &bytes).map_or(0, |end| end + 1);
        }
        let text = String::from_utf8(bytes)
            .unwrap_or_else(|bytes| String::from_utf8_lossy(bytes.as_bytes()).into_owned());
        Ok(Content { text, fault })
    }

    /// Error at the fault that ends the text.
    pub fn complaint(&self, file: FileId) -> Option<Diagnostic> {
        let fault = self.fault?;
        let last = self.text.rsplit('\n').next().unwrap_or_default();
        let line = 1 + self.text.bytes().filter(|&byte| byte == b'\n').count();
        let span = Span {
            file,
            line: line as u32,
            column: last.chars().count() as u32 + 1,
            length: 1,
            instance: 0,
        };
        Some(match fault {
            0 => Diagnostic::error(Code::NotText, span, "a NUL byte: this is not a text")
                .help("a deck is plain text, in ASCII or UTF-8"),
            _ => {
                let message = format!("a line of more than {LONGEST_LINE} bytes");
                Diagnostic::error(Code::EndlessLine, span, message)
                    .help("lists may run over any number of lines")
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(content: &Content) -> (u32, u32, Code) {
        let error = content.complaint(FileId(0)).expect("a fault");
        let span = error.span.expect("a place");
        (span.line, span.column, error.code)
    }

    #[test]
    fn reading_ends_at_the_first_fault() {
        let zeros = Content::read(b"*NODE\n1, ".chain(io::repeat(0))).expect("read");
        assert_eq!(zeros.text, "*NODE\n1, ");
        assert_eq!(place(&zeros), (2, 4, Code::NotText));
        let line = Content::read(b"*NODE\n".chain(io::repeat(b'A'))).expect("read");
        assert_eq!(line.text.len(), 6 + LONGEST_LINE);
        let column = LONGEST_LINE as u32 + 1;
        assert_eq!(place(&line), (2, column, Code::EndlessLine));
    }

    #[test]
    fn lines_up_to_the_limit_are_sound() {
        let text = vec!["a".repeat(LONGEST_LINE); 60].join("\n");
        let content = Content::new(&text);
        assert!(content.text == text && content.complaint(FileId(0)).is_none());
        assert!(Content::new("").complaint(FileId(0)).is_none());
    }
}
