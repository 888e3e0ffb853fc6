import type { ReactNode } from "react";
import { formatNumber } from "../live/rounding";
import { getRegistration } from "../api";
import { QueryStatus } from "../rest/QueryStatus";
import { useQuery } from "../rest/useQuery";
import type { Signable } from "../room/messages";
import { useTexts } from "../texts/TextsContext";
import { rowsOf } from "./registrationRows";
import { SignBox } from "./SignBox";

/** The registration with its values, limits and co-signature. */
export function RegistrationPanel({ signable }: { signable: Signable }): ReactNode {
  const texts = useTexts().supervisor;
  const own = texts.registration;
  const key = signable.document_id ?? "";
  const query = useQuery((signal) => (key === "" ? Promise.resolve(null) : getRegistration({ signal })), {
    key,
  });
  if (key === "") return <p className="soft">{own.none}</p>;
  const { data } = query;
  if (data === null) return <QueryStatus query={query} />;
  return (
    <>
      <p>
        <b>{data.vertebra}</b> · {own.by} {data.method} · {own.fixedTo} {data.reference ?? own.camera}
      </p>
      <table className="registration-numbers">
        <tbody>
          {rowsOf(data.numbers).map((row) => (
            <tr key={row.name} data-past={row.past}>
              <th scope="row">{own.numbers[row.name]}</th>
              <td>
                {row.past && <span aria-hidden="true">▲ </span>}
                {formatNumber(row.value, row.unit === "" ? 0 : 2)} {row.unit}
              </td>
              <td className="soft">
                {row.limit !== null && `${own.allowed} ${formatNumber(row.limit, 2)} ${row.unit}`}
              </td>
            </tr>
          ))}
        </tbody>
      </table>
      {data.heading.id === signable.document_id && <SignBox signable={signable} />}
    </>
  );
}
