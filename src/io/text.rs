//! What the text formats share: words, numbers, and colours whose range only the whole file tells.

use std::io::{self, Write};
use std::str::FromStr;

use crate::mesh::{Attributes, Mesh};

/// The words of a line.
pub(super) fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty())
}

/// `word` as it may stand in a message.
pub(super) fn quoted(word: &[u8]) -> String {
    const LONGEST: usize = 40;
    let shown = String::from_utf8_lossy(&word[..word.len().min(LONGEST)]).into_owned();
    if word.len() > LONGEST { format!("'{shown}...'") } else { format!("'{shown}'") }
}

/// A number of any type; the error is a sentence.
pub(super) fn number<T: FromStr>(word: &[u8]) -> Result<T, String> {
    std::str::from_utf8(word)
        .ok()
        .and_then(|word| word.parse().ok())
        .ok_or_else(|| format!("{} is not a number that can stand here", quoted(word)))
}

/// The next `N` words as finite numbers; the error is a sentence about `what`.
pub(super) fn floats<'a, const N: usize>(
    words: &mut impl Iterator<Item = &'a [u8]>,
    what: &str,
) -> Result<[f32; N], String> {
    let mut values = [0.0; N];
    for (found, value) in values.iter_mut().enumerate() {
        let word = words.next().ok_or_else(|| format!("a {what} needs {N} numbers, but has {found}"))?;
        *value = finite(word)?;
    }
    Ok(values)
}

fn finite(word: &[u8]) -> Result<f32, String> {
    let value: f32 = number(word)?;
    if value.is_finite() { Ok(value) } else { Err(format!("{} is not a finite number", quoted(word))) }
}

pub(super) const WHITE: [u8; 4] = [255; 4];

/// Colours as files have them: some count from 0 to 1, some from 0 to 255, and none says which.
///
/// A file that writes a fraction, or nothing above 1, counts to 1.
#[derive(Default)]
pub(super) struct TextColors {
    values: Vec<[f32; 4]>,
    fractions: bool,
    above_one: bool,
}

impl TextColors {
    /// Takes three or four words as the colour of `vertex`; vertices passed over are white.
    pub(super) fn set(&mut self, vertex: usize, words: &[&[u8]]) -> Result<(), String> {
        // Infinity is full in either range.
        let mut color = [f32::INFINITY; 4];
        for (value, word) in color.iter_mut().zip(words) {
            *value = finite(word)?;
            self.fractions |= number::<i64>(word).is_err();
            self.above_one |= *value > 1.0;
        }
        self.values.resize(vertex, [f32::INFINITY; 4]);
        self.values.push(color);
        Ok(())
    }

    /// One colour for each of `vertices` vertices, or none if none was set.
    pub(super) fn finish(self, vertices: usize) -> Option<Vec<[u8; 4]>> {
        let scale = if self.fractions || !self.above_one { 255.0 } else { 1.0 };
        let mut colors: Vec<_> =
            self.values.iter().map(|color| color.map(|value| (value * scale).round() as u8)).collect();
        (!colors.is_empty()).then(|| {
            colors.resize(vertices, WHITE);
            colors
        })
    }
}

/// Writes a line a vertex (position, normal, colour as `write_color` has it, texture coordinates) and
/// then a line a triangle: the body of PLY and of OFF.
pub(super) fn write_elements<W: Write>(
    mesh: &Mesh,
    writer: &mut W,
    write_color: impl Fn(&mut W, [u8; 4]) -> io::Result<()>,
) -> io::Result<()> {
    let Attributes { normals, colors, uvs } = mesh.attributes();
    for (vertex, [x, y, z]) in mesh.positions().iter().enumerate() {
        write!(writer, "{x:?} {y:?} {z:?}")?;
        if let Some([x, y, z]) = normals.as_ref().map(|normals| normals[vertex]) {
            write!(writer, " {x:?} {y:?} {z:?}")?;
        }
        if let Some(color) = colors.as_ref().map(|colors| colors[vertex]) {
            write_color(writer, color)?;
        }
        if let Some([u, v]) = uvs.as_ref().map(|uvs| uvs[vertex]) {
            write!(writer, " {u:?} {v:?}")?;
        }
        writer.write_all(b"\n")?;
    }
    for [a, b, c] in mesh.triangles() {
        writeln!(writer, "3 {a} {b} {c}")?;
    }
    Ok(())
}
