"use strict";
// Numbers as text, as the command line writes them: few digits, no more than an interval leaves.

// A number of so many digits; a power of ten only where it is very large or small.
function plainNumber(value, digits = 5) {
  if (!Number.isFinite(value)) return Number.isNaN(value) ? "nan" : value > 0 ? "inf" : "-inf";
  const rounded = Number(value.toPrecision(digits)), size = Math.abs(rounded);
  if (size === 0 || (size >= 1e-4 && size < 1e7)) return String(rounded);
  return rounded.toExponential().replace(/([+-])(\d)$/, "$10$2");
}

// A number to so many places behind the point, before it where they are below zero.
function fixedNumber(value, places) {
  const unit = 10 ** Math.max(-places, 0);
  const text = (places < 0 ? Math.round(value / unit) * unit : value).toFixed(Math.max(places, 0));
  return Number(text) === 0 ? text.replace("-", "") : text;
}

// Places behind the point that so many digits of a number reach.
function placesOf(value, digits) {
  return value === 0 ? 0 : Math.min(digits - 1 - Number(value.toExponential().split("e")[1]), 12);
}

// Places of a number that is known within half widths; null where it is plain digits better.
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
  return size >= 1e5 && size < 1e7 ? value.toFixed(0) : short(value);
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
