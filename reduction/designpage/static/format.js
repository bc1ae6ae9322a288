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

// A number for a table; a dash where there is none.
function short(value, digits = 5) {
  return Number.isFinite(value) ? general(value, digits) : "-";
}

// Numbers of the data: null is none, the text inf is infinite.
function numbersOf(value) {
  if (Array.isArray(value)) return value.map(numbersOf);
  if (value === null) return NaN;
  if (value === "inf") return Infinity;
  return value === "-inf" ? -Infinity : value;
}
