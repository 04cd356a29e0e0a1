//! Lengths with units, view boxes and transforms, to user units.

use crate::error::Error;
use kurbo::{Affine, Rect, Size};
use std::str::FromStr;
use svgtypes::{Align, AspectRatio, LengthUnit};

/// CSS pixels per inch, the SVG and CSS reference.
const PX_PER_INCH: f64 = 96.0;

/// A length as a person writes it for a parameter: a number of user units, or with a unit
/// (`mm cm in pt pc px`), which then is a real size on paper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Length {
    number: f64,
    unit: LengthUnit,
}

impl Length {
    /// A length in user units of the root.
    pub fn user(number: f64) -> Self {
        Length { number, unit: LengthUnit::None }
    }

    /// User units of the root, where one user unit is `px_per_unit` CSS pixels.
    pub fn to_user(self, px_per_unit: f64) -> f64 {
        match self.unit {
            LengthUnit::None => self.number,
            unit => self.number * px_per(unit, 16.0) / px_per_unit,
        }
    }
}

impl FromStr for Length {
    type Err = Error;

    /// Errors on anything but a finite number with an optional absolute unit.
    fn from_str(text: &str) -> Result<Self, Error> {
        let wrong = || {
            Error::new(
                "bad-length",
                format!("'{text}' is not a length"),
                "Write a number, with a unit if you like, such as 12 or 4mm",
            )
        };
        let length = svgtypes::Length::from_str(text.trim()).map_err(|_| wrong())?;
        if !length.number.is_finite()
            || matches!(length.unit, LengthUnit::Percent | LengthUnit::Em | LengthUnit::Ex)
        {
            return Err(wrong());
        }
        Ok(Length { number: length.number, unit: length.unit })
    }
}

impl std::fmt::Display for Length {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let unit = match self.unit {
            LengthUnit::Mm => "mm",
            LengthUnit::Cm => "cm",
            LengthUnit::In => "in",
            LengthUnit::Pt => "pt",
            LengthUnit::Pc => "pc",
            LengthUnit::Px => "px",
            _ => "",
        };
        write!(f, "{}{unit}", self.number)
    }
}

/// CSS pixels in one `unit`; `em` is the font size in px. Percentages are not lengths.
fn px_per(unit: LengthUnit, em: f64) -> f64 {
    match unit {
        LengthUnit::In => PX_PER_INCH,
        LengthUnit::Cm => PX_PER_INCH / 2.54,
        LengthUnit::Mm => PX_PER_INCH / 25.4,
        LengthUnit::Pt => PX_PER_INCH / 72.0,
        LengthUnit::Pc => PX_PER_INCH / 6.0,
        LengthUnit::Em => em,
        // Half an em stands for the x-height where no font is at hand, as CSS allows.
        LengthUnit::Ex => em / 2.0,
        LengthUnit::None | LengthUnit::Px | LengthUnit::Percent => 1.0,
    }
}

/// What percentages and font-relative units refer to at some place in the drawing.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Units {
    pub viewport: Size,
    pub em: f64,
}

/// Which side of the viewport a percentage is of.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Axis {
    X,
    Y,
    /// The normalized diagonal, for radii and stroke widths.
    Diagonal,
}

impl Units {
    /// User units of the place, or `None` if the text is no length.
    pub fn resolve(&self, text: &str, axis: Axis) -> Option<f64> {
        let length = svgtypes::Length::from_str(text.trim()).ok()?;
        Some(self.convert(length, axis))
    }

    fn convert(&self, length: svgtypes::Length, axis: Axis) -> f64 {
        match length.unit {
            LengthUnit::Percent => {
                let Size { width, height } = self.viewport;
                let base = match axis {
                    Axis::X => width,
                    Axis::Y => height,
                    Axis::Diagonal => ((width * width + height * height) / 2.0).sqrt(),
                };
                length.number / 100.0 * base
            }
            unit => length.number * px_per(unit, self.em),
        }
    }
}

/// The transform that `viewBox` and `preserveAspectRatio` make in a viewport of this size.
/// `None` for a view box of zero or negative size, which disables rendering.
pub(crate) fn view_box_transform(view: Rect, aspect: AspectRatio, viewport: Size) -> Option<Affine> {
    if !(view.width() > 0.0 && view.height() > 0.0 && viewport.width > 0.0 && viewport.height > 0.0) {
        return None;
    }
    let (mut sx, mut sy) = (viewport.width / view.width(), viewport.height / view.height());
    if aspect.align != Align::None {
        let scale = if aspect.slice { sx.max(sy) } else { sx.min(sy) };
        (sx, sy) = (scale, scale);
    }
    let spare_x = viewport.width - view.width() * sx;
    let spare_y = viewport.height - view.height() * sy;
    let (fx, fy) = match aspect.align {
        Align::None | Align::XMinYMin => (0.0, 0.0),
        Align::XMidYMin => (0.5, 0.0),
        Align::XMaxYMin => (1.0, 0.0),
        Align::XMinYMid => (0.0, 0.5),
        Align::XMidYMid => (0.5, 0.5),
        Align::XMaxYMid => (1.0, 0.5),
        Align::XMinYMax => (0.0, 1.0),
        Align::XMidYMax => (0.5, 1.0),
        Align::XMaxYMax => (1.0, 1.0),
    };
    Some(Affine::new([sx, 0.0, 0.0, sy, spare_x * fx - view.x0 * sx, spare_y * fy - view.y0 * sy]))
}

/// Parses `viewBox`; `None` if it is absent or not four finite numbers.
pub(crate) fn view_box(text: &str) -> Option<Rect> {
    let view = svgtypes::ViewBox::from_str(text).ok()?;
    let rect = Rect::new(view.x, view.y, view.x + view.w, view.y + view.h);
    rect.is_finite().then_some(rect)
}

/// Parses a `transform` list.
pub(crate) fn transform(text: &str) -> Option<Affine> {
    let t = svgtypes::Transform::from_str(text).ok()?;
    Some(Affine::new([t.a, t.b, t.c, t.d, t.e, t.f]))
}

/// Mean scale of a transform: the square root of its area factor.
pub(crate) fn mean_scale(transform: Affine) -> f64 {
    transform.determinant().abs().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameter_lengths_follow_the_paper_size() {
        // A millimetre document: one user unit is a millimetre.
        let px_per_unit = 96.0 / 25.4;
        assert_eq!("12".parse::<Length>().unwrap().to_user(px_per_unit), 12.0);
        assert!(("1cm".parse::<Length>().unwrap().to_user(px_per_unit) - 10.0).abs() < 1e-12);
        assert!("3 %".parse::<Length>().is_err());
        assert!("wide".parse::<Length>().is_err());
    }

    #[test]
    fn view_boxes_meet_slice_and_align() {
        let view = Rect::new(10.0, 0.0, 20.0, 10.0);
        let meet = view_box_transform(view, AspectRatio::default(), Size::new(40.0, 20.0)).unwrap();
        assert_eq!(meet * kurbo::Point::new(15.0, 5.0), kurbo::Point::new(20.0, 10.0));
        assert_eq!(meet * kurbo::Point::new(10.0, 0.0), kurbo::Point::new(10.0, 0.0));
        assert!(view_box_transform(Rect::ZERO, AspectRatio::default(), Size::new(1.0, 1.0)).is_none());
    }
}
