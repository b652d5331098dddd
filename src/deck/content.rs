//! Text of a deck file, read up to the first NUL byte or overlong line.

use crate::diagnostics::{Code, Diagnostic, FileId, Span};
use memchr::{memchr, memrchr};
use std::fs::File;
use std::io;
use std::io::{BufRead, BufReader};
use std::path::Path;

/// Longest line, in bytes.
pub(crate) const LONGEST_LINE: usize = 1 << 16;

/// Longest line that other codes read.
pub(crate) const LONGEST_USUAL_LINE: usize = 256;

/// Content that shows that a file is not a deck.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Fault {
    /// A NUL byte.
    Nul,
    /// A line longer than [`LONGEST_LINE`].
    Endless,
}

/// Text of a file.
pub(crate) struct Content {
    /// The text, up to the fault if there is one.
    pub text: String,
    /// Whether it holds nothing but ASCII without quotation marks, in lines that all codes read.
    pub is_plain: bool,
    fault: Option<Fault>,
}

impl Content {
    /// Reads a regular file; stops at the first fault, however long the file is.
    pub fn of(path: &Path) -> io::Result<Content> {
        Content::read(BufReader::with_capacity(LONGEST_LINE, File::open(path)?))
    }

    /// Reads to the end or to the first fault.
    fn read(mut input: impl BufRead) -> io::Result<Content> {
        let (mut bytes, mut fault, mut length) = (Vec::new(), None, 0);
        let mut is_plain = true;
        while fault.is_none() {
            let more = input.fill_buf()?;
            if more.is_empty() {
                break;
            }
            let before = length;
            let used = sound(more, &mut length);
            fault = more.get(used).map(|&byte| match byte {
                0 => Fault::Nul,
                _ => Fault::Endless,
            });
            let sound = more.get(..used).unwrap_or_default();
            is_plain &= are_plain(sound, before);
            bytes.extend_from_slice(sound);
            let used = more.len();
            input.consume(used);
        }
        let text = String::from_utf8(bytes)
            .unwrap_or_else(|bytes| String::from_utf8_lossy(bytes.as_bytes()).into_owned());
        Ok(Content {
            text,
            is_plain,
            fault,
        })
    }

    /// Content given as text.
    pub fn new(text: &str) -> Content {
        // Reading from memory cannot fail.
        Content::read(text.as_bytes()).unwrap_or(Content {
            text: String::new(),
            is_plain: true,
            fault: None,
        })
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
        let error = |code, message: String| Diagnostic::error(code, span, message);
        Some(match fault {
            Fault::Nul => error(Code::NotText, "a NUL byte: this is not a text".to_string())
                .help("a deck is plain text, in ASCII or UTF-8"),
            Fault::Endless => {
                let message = format!("a line of more than {LONGEST_LINE} bytes");
                error(Code::EndlessLine, message).help("lists may run over any number of lines")
            }
        })
    }
}

/// Whether bytes are ASCII without quotation marks, in lines that all codes read; the first one
/// continues a line of `before` bytes.
fn are_plain(bytes: &[u8], before: usize) -> bool {
    bytes.is_ascii()
        && memchr(b'"', bytes).is_none()
        && lines_fit(bytes, before, LONGEST_USUAL_LINE)
}

/// Whether no line is longer than `most` bytes, of which the first one has `before` already; a line
/// that ends with CRLF may be said to be.
pub(super) fn lines_fit(bytes: &[u8], before: usize, most: usize) -> bool {
    let (mut rest, mut begun) = (bytes, before);
    while begun + rest.len() > most {
        let room = most.checked_sub(begun).and_then(|room| rest.get(..=room));
        match memrchr(b'\n', room.unwrap_or_default()) {
            Some(end) => (rest, begun) = (rest.get(end + 1..).unwrap_or_default(), 0),
            None => return false,
        }
    }
    true
}

/// Number of bytes before the first fault; `length` is that of the line so far.
fn sound(bytes: &[u8], length: &mut usize) -> usize {
    let text = memchr(0, bytes).map_or(bytes, |nul| bytes.split_at(nul).0);
    let mut start = 0;
    loop {
        // the last line end that the line so far may reach
        let rest = text.get(start..).unwrap_or_default();
        let most = LONGEST_LINE - *length;
        match memrchr(b'\n', rest.get(..=most).unwrap_or(rest)) {
            Some(end) => (start, *length) = (start + end + 1, 0),
            None if rest.len() > most => return start + most,
            None => {
                *length += rest.len();
                return text.len();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An input without end.
    struct Endless(&'static [u8]);

    impl io::Read for Endless {
        fn read(&mut self, _: &mut [u8]) -> io::Result<usize> {
            Ok(0)
        }
    }

    impl BufRead for Endless {
        fn fill_buf(&mut self) -> io::Result<&[u8]> {
            Ok(self.0)
        }

        fn consume(&mut self, _: usize) {}
    }

    fn place(content: &Content) -> (u32, u32, Code) {
        let error = content.complaint(FileId(0)).expect("a fault");
        let span = error.span.expect("a place");
        (span.line, span.column, error.code)
    }

    #[test]
    fn reading_ends_at_the_first_fault() {
        let zeros = Content::read(Endless(b"*NODE\n1, \0\0")).expect("read");
        assert_eq!(zeros.text, "*NODE\n1, ");
        assert_eq!(place(&zeros), (2, 4, Code::NotText));
        let line = Content::read(Endless(b"*NODE, NSET=AAAA")).expect("read");
        assert_eq!(line.text.len(), LONGEST_LINE);
        let column = LONGEST_LINE as u32 + 1;
        assert_eq!(place(&line), (1, column, Code::EndlessLine));
    }

    #[test]
    fn lines_up_to_the_limit_are_sound() {
        let text = format!("{}\n{}", "a".repeat(LONGEST_LINE), "b".repeat(LONGEST_LINE));
        let content = Content::new(&text);
        assert!(content.text == text && content.complaint(FileId(0)).is_none());
        assert!(Content::new("").complaint(FileId(0)).is_none());
    }
}
