"use strict";
// Numbers as text, by the rules of Python: halves of exact binary values go to the even digit.

// Digits and power of ten of a finite number above zero.
function decimalOf(value, digits) {
  const [mantissa, power] = value.toExponential(digits - 1).split("e");
  let text = mantissa.replace(".", "");
  // the language rounds a half up; it is one where nothing follows the 5
  const more = value.toExponential(100).split("e")[0].replace(".", "");
  if (/^50*$/.test(more.slice(digits)) && Number(power) === Number(value.toExponential(100).split("e")[1])
      && Number(text[digits - 1]) % 2) {
    text = text.slice(0, -1) + String(Number(text[digits - 1]) - 1);
  }
  return [text, Number(power)];
}

function signOf(value) {
  return value < 0 || Object.is(value, -0) ? "-" : "";
}

function notFinite(value) {
  return Number.isNaN(value) ? "nan" : value > 0 ? "inf" : "-inf";
}

function powerText(power) {
  return `e${power < 0 ? "-" : "+"}${String(Math.abs(power)).padStart(2, "0")}`;
}

// As f"{value:.{digits}g}".
function general(value, digits) {
  if (!Number.isFinite(value)) return notFinite(value);
  if (value === 0) return `${signOf(value)}0`;
  const [text, power] = decimalOf(Math.abs(value), digits);
  const bare = text.replace(/0+$/, "");
  if (power < -4 || power >= digits) {
    const mantissa = bare.length > 1 ? `${bare[0]}.${bare.slice(1)}` : bare;
    return signOf(value) + mantissa + powerText(power);
  }
  if (power < 0) return `${signOf(value)}0.${"0".repeat(-power - 1)}${bare}`;
  const whole = text.slice(0, power + 1);
  const rest = text.slice(power + 1).replace(/0+$/, "");
  return signOf(value) + whole + (rest ? `.${rest}` : "");
}

// As f"{value:.{digits}f}", and with a sign as f"{value:+.{digits}f}".
function fixed(value, digits, plus = "") {
  if (!Number.isFinite(value)) return (value < 0 ? "" : plus) + notFinite(value);
  const size = Math.abs(value);
  if (size >= 1e21) {
    // beyond, the language changes to powers; such a number is whole
    return (signOf(value) || plus) + BigInt(size) + (digits ? `.${"0".repeat(digits)}` : "");
  }
  let text = size.toFixed(digits);
  const more = size.toFixed(100);
  const point = more.indexOf(".");
  if (/^50*$/.test(more.slice(point + 1 + digits))) {
    const last = Number(text[text.length - 1]);
    // a half went up: back to the even digit
    if (last % 2) text = text.slice(0, -1) + String(last - 1);
  }
  return (signOf(value) || plus) + text;
}

// As f"{value:.{digits}e}".
function scientific(value, digits) {
  if (!Number.isFinite(value)) return notFinite(value);
  if (value === 0) return `${signOf(value)}${(0).toFixed(digits)}e+00`;
  const [text, power] = decimalOf(Math.abs(value), digits + 1);
  return signOf(value) + (digits ? `${text[0]}.${text.slice(1)}` : text) + powerText(power);
}

// As reduction.digits.plain_number.
function plainNumber(value, digits = 5) {
  const text = general(value, digits), size = Math.abs(Number(text));
  return size >= 10 ** digits && size < 1e7 ? fixed(Number(text), 0) : text;
}

// As reduction.digits.fixed_number, with no mark between thousands.
function fixedNumber(value, places) {
  const unit = 10 ** Math.max(-places, 0);
  let rounded = value;
  if (places < 0) {
    const count = value / unit, whole = Math.round(count);
    // the language rounds a half up
    rounded = (Math.abs(count % 1) === 0.5 && whole % 2 ? whole - 1 : whole) * unit;
  }
  const text = fixed(rounded, Math.max(places, 0));
  return Number(text) === 0 ? text.replace("-", "") : text;
}

// As reduction.digits.places_of.
function placesOf(value, digits) {
  if (value === 0) return 0;
  return Math.min(digits - 1 - Number(value.toExponential(16).split("e")[1]), 12);
}

// As reduction.digits.places_within; null where that is None.
function placesWithin(value, halves) {
  const known = halves.filter((half) => Number.isFinite(half) && half > 0);
  const size = Math.max(Math.abs(value), ...known);
  if (!known.length || size < 1e-4 || size >= 1e9) return null;
  return Math.max(Math.min(placesOf(Math.min(...known), 2), placesOf(value, 7)), placesOf(value, 2));
}

// A number for a table; a dash where there is none.
function short(value, digits = 5) {
  return Number.isFinite(value) ? plainNumber(value, digits) : "-";
}

// A level for a table: of a large one no digit before the point is lost.
function asGiven(value) {
  const size = Math.abs(value);
  return size >= 1e5 && size < 1e7 ? fixed(value, 0) : short(value);
}

// A number that is known within half widths of intervals, to two digits of the narrowest.
function within(value, ...halves) {
  const places = Number.isFinite(value) ? placesWithin(value, halves) : null;
  return places === null ? short(value) : fixedNumber(value, places);
}

// What is shown of a number of the page: a narrow blank between thousands from 100000 on.
function grouped(text) {
  return text.replace(/(?<![\d.])\d{6,}/g, (digits) => digits.replace(/\B(?=(\d{3})+$)/g, "\u202f"));
}

// Numbers of the data: null is none, the text inf is infinite.
function numbersOf(value) {
  if (Array.isArray(value)) return value.map(numbersOf);
  if (value === null) return NaN;
  if (value === "inf") return Infinity;
  return value === "-inf" ? -Infinity : value;
}
