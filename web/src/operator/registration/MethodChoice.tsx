import type { ReactNode } from "react";
import { Link } from "wouter";
import type { RegistrationMessage } from "../../api";
import { useTexts } from "../../texts/TextsContext";
import { SetupCheckNote } from "../SetupCheckNote";
import type { Way } from "./RegistrationPage";
import { RegistrationNow } from "./RegistrationNow";
import { useActiveProcedures } from "./useActiveProcedures";

// All methods but that of the rehearsal, which the server provides. A method without its page would not be offered.
type Method = Exclude<RegistrationMessage["method"], "rehearsal">;
const PATH: Record<Method, Way> = { points: "points", needles: "needles", surface: "sweep" };

const addressOf = (method: Method): string => `/operator/register/${PATH[method]}`;

/** Registration methods, with what each determines and misses, and their state. */
export function MethodChoice(): ReactNode {
  const texts = useTexts().registration;
  const running = useActiveProcedures().data;
  const begun = { points: running?.points === true, needles: false, surface: running?.sweep === true };
  const method = (Object.keys(PATH) as Method[]).find((one) => begun[one]);
  return (
    <div className="registration">
      <RegistrationNow begun={method === undefined ? null : { method, href: addressOf(method) }} />
      <SetupCheckNote />
      <ul className="methods">
        {(Object.keys(PATH) as Method[]).map((method) => (
          <li key={method}>
            <Link href={addressOf(method)} data-testid={`method-${method}`}>
              <strong>{texts.method[method]}</strong>
              <span className="method-does">{texts.choice[method].does}</span>
              <span>
                <b aria-hidden="true">✓ </b>
                {texts.choice[method].sees}
              </span>
              <span className="method-blind">
                <b aria-hidden="true">▲ </b>
                {texts.choice[method].misses}
              </span>
              {begun[method] && <em>↻ {texts.choice.begun}</em>}
            </Link>
          </li>
        ))}
      </ul>
    </div>
  );
}
