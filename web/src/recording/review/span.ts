// The visible span of a recording, in seconds since the first image. Pure.

export interface Span {
  fromS: number;
  toS: number;
}

const MIN_SPAN_S = 1;

/** Clamps a span to the recording, with a minimum of one second where possible. */
export function clampSpan({ fromS, toS }: Span, durationS: number): Span {
  const length = Math.min(Math.max(toS - fromS, MIN_SPAN_S), Math.max(durationS, MIN_SPAN_S));
  const middle = (fromS + toS) / 2;
  const from = Math.min(Math.max(middle - length / 2, 0), Math.max(0, durationS - length));
  return { fromS: from, toS: from + length };
}

/** Scales the span; `aboutS` stays in place. */
export function zoomSpan(span: Span, times: number, aboutS: number, durationS: number): Span {
  const fromS = aboutS - (aboutS - span.fromS) / times;
  const toS = aboutS + (span.toS - aboutS) / times;
  return clampSpan({ fromS, toS }, durationS);
}

/** Shifts the span by a share of its length. */
export function moveSpan({ fromS, toS }: Span, share: number, durationS: number): Span {
  const by = share * (toS - fromS);
  return clampSpan({ fromS: fromS + by, toS: toS + by }, durationS);
}

/** Position of a time in the span: 0 to 1 inside. */
export const ratioAt = (span: Span, atS: number): number => (atS - span.fromS) / (span.toS - span.fromS);

export const timeAt = (span: Span, ratio: number): number => span.fromS + ratio * (span.toS - span.fromS);
