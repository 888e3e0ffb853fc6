import type { ReactNode } from "react";
import { useTexts } from "../texts/TextsContext";

/** A lumbar vertebra seen along the spine, its spinous process on top. */
const BONE =
  "M180 320C180 284 202 270 215 262L205 232L122 215C105 210 105 195 122 193L215 190L230 180L280 165L289 138" +
  "C292 122 308 122 311 138L320 165L370 180L385 190L478 193C495 195 495 210 478 215L395 232L385 262" +
  "C398 270 420 284 420 320C420 378 360 396 300 396C240 396 180 378 180 320Z";
const CANAL = "M300 196C345 196 352 230 340 252C330 268 270 268 260 252C248 230 255 196 300 196Z";

/** The principle: a camera sees the marker on a drill, and a screen shows the drill relative to the planned channel. */
export function AboutDrawing(): ReactNode {
  const texts = useTexts().signIn.about;
  return (
    <svg className="about-drawing" viewBox="0 0 640 420" role="img" aria-label={texts.drawing}>
      <path className="about-bone" fillRule="evenodd" d={BONE + CANAL} />
      {/* The planned channel, and the drill's axis at a small angle to it. */}
      <g transform="translate(392 188) rotate(21.8)">
        <path className="about-channel" d="M-15 0V172M15 0V172M-15 172H15" />
        <path className="about-axis" d="M0 64V172" />
      </g>
      <g transform="translate(392 188) rotate(25)">
        <path className="about-drill" d="M-6 -150H6V44L0 64L-6 44Z" />
        <rect className="about-handle" x="-17" y="-182" width="34" height="60" rx="10" />
        <rect className="about-marker" x="-27" y="-108" width="54" height="54" />
        <rect className="about-marker-inside" x="-14" y="-95" width="28" height="28" />
      </g>
      {/* The camera, and what it sees of the marker. */}
      <path className="about-sight" d="M140 56L410 82M140 76L384 124" />
      <path className="about-camera" d="M40 36H112V96H40ZM112 54L140 42V90L112 78Z" />
      {/* The screen: the drill's tip in the channel, seen along it. */}
      <path className="about-camera" d="M496 272H624V368H496ZM540 368H580V388H540Z" />
      <circle className="about-channel" cx="560" cy="320" r="34" />
      <circle className="about-spot" cx="566" cy="316" r="9" />
      <g className="about-names">
        <text x="76" y="126" textAnchor="middle">
          {texts.camera}
        </text>
        <text x="470" y="112">
          {texts.marker}
        </text>
        <text x="486" y="44">
          {texts.drill}
        </text>
        <text x="560" y="412" textAnchor="middle">
          {texts.screen}
        </text>
        <text className="about-planned" x="150" y="412" textAnchor="middle">
          {texts.channel}
        </text>
      </g>
      <path className="about-leader" d="M226 394L330 352" />
    </svg>
  );
}
