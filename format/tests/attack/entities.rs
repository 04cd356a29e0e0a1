//! Entities, the document type, and whatever else could make the parser open or grow something.

use crate::code;
use crate::support::svg;
use std::fmt::Write;

#[test]
fn entity_bombs() {
    let mut exponential = String::from("<!DOCTYPE s [<!ENTITY a0 'aaaaaaaaaa'>");
    for i in 1..40 {
        let _ = write!(exponential, "<!ENTITY a{i} '{}'>", format!("&a{};", i - 1).repeat(10));
    }
    let in_text = format!("{exponential}]>{}", svg("<text>&a39;</text>"));
    assert_eq!(code(in_text), "entity-expansion");
    assert_eq!(code(format!("{exponential}]>{}", svg("<g id='&a39;'/>"))), "entity-expansion");
    let big = format!("<!DOCTYPE s [<!ENTITY a '{}'>]>", "x".repeat(100_000));
    assert_eq!(code(format!("{big}{}", svg(&"&a;".repeat(100_000)))), "entity-expansion");
    let empty = format!("<!DOCTYPE s [<!ENTITY a ''>]>{}", svg(&"&a;".repeat(1_000_000)));
    assert_eq!(code(empty), "entity-expansion");
    let cycle = format!("<!DOCTYPE s [<!ENTITY a '&b;'><!ENTITY b '&a;'>]>{}", svg("&a;"));
    assert_eq!(code(cycle), "entity-expansion");
    let itself = format!("<!DOCTYPE s [<!ENTITY a '&a;'>]>{}", svg("&a;"));
    assert_eq!(code(itself), "entity-expansion");
    let markup = format!("<!DOCTYPE s [<!ENTITY a '{}'>]>", "<g/>".repeat(1000));
    assert_eq!(code(format!("{markup}{}", svg(&"&a;".repeat(1000)))), "entity-expansion");
    let many: String = (0..200_000).map(|i| format!("<!ENTITY e{i} '&e{};'>", i + 1)).collect();
    assert_eq!(code(format!("<!DOCTYPE s [{many}]>{}", svg("&e0;"))), "entity-expansion");
    let parameter = format!("<!DOCTYPE s [<!ENTITY % p '{}'>]>", "x".repeat(1 << 20));
    assert_eq!(code(format!("{parameter}{}", svg("&p;&p;"))), "entity-expansion");
}

#[test]
fn entities_that_open_what_they_do_not_close() {
    let with = |value: &str, body: &str| code(format!("<!DOCTYPE s [<!ENTITY e '{value}'>]>{}", svg(body)));
    assert_eq!(with("<g>", &("&e;".repeat(60_000) + &"</g>".repeat(60_000))), "entity-expansion");
    assert_eq!(with("<g></g></g>", "<g>&e;"), "entity-expansion");
    assert_eq!(with("</svg>", "&e;"), "entity-expansion");
    let attributes: String = (0..4000).map(|i| format!(" a{i}=\"\"")).collect();
    assert_eq!(with(&format!("<g{attributes}"), &"&e;".repeat(100)), "entity-expansion");
    // Balanced, yet it closes the element around it: the parser refuses or reads it.
    for value in ["</g><g>", "<a></a></g><g>", "<g/><!--", "<![CDATA[", "<g><!-- </g> -->", "<"] {
        with(value, "<g class='rinceau-guide'>&e;<path d='M0 0L1 1'/></g>");
    }
}

#[test]
fn nothing_outside_the_file_is_read() {
    let external = "<!DOCTYPE svg [<!ENTITY x SYSTEM 'file:///etc/passwd'>]>";
    assert_eq!(code(format!("{external}{}", svg("<text>&x;</text>"))), "unknown-entity");
    let subset = "<!DOCTYPE svg SYSTEM 'file:///dev/zero'>";
    assert_eq!(code(format!("{subset}{}", svg(""))), "read");
    let include = svg("<xi:include xmlns:xi='http://www.w3.org/2001/XInclude' href='/etc/passwd'/>");
    assert_eq!(code(include), "read");
    for href in ["file:///etc/passwd", "/dev/zero", "../x.svg#a", "\\\\.\\COM1", "http://127.0.0.1/#a", "x#y"]
    {
        let body = format!("<g class='rinceau-fixed'><use href='{href}'/><image href='{href}'/></g>");
        assert_eq!(code(svg(&body)), "read");
        assert_eq!(code(svg(&format!("<style>@import url('{href}');</style>"))), "read");
    }
}

#[test]
fn junk_in_the_document_type() {
    let junk = [
        "<!DOCTYPE",
        "<!DOCTYPE svg",
        "<!DOCTYPE svg [",
        "<!DOCTYPE svg [<",
        "<!DOCTYPE svg [<!ENTITY",
        "<!DOCTYPE svg [<!ENTITY a",
        "<!DOCTYPE svg [<!ENTITY a '",
        "<!DOCTYPE svg [<!ENTITY é 'é'>",
        "<!DOCTYPE svg [<!ENTITY % é 'é'>]",
        "<!DOCTYPE svg [%p;]>",
        "<!DOCTYPE svg [<![INCLUDE[]]>]>",
        "<!DOCTYPE svg []]>",
        "<!DOCTYPE svg [é]>",
        "<!DOCTYPE svg PUBLIC 'é' \"'\" [<!ELEMENT g ANY>]>",
        "<!DOCTYPE svg [<!ATTLIST svg x CDATA '>'>]>",
        "<!DOCTYPE svg [<!-- ]> -->]><!DOCTYPE svg>",
    ];
    for text in junk {
        code(text);
        code(format!("{text}{}", svg("<g/>")));
    }
    let many = "<!DOCTYPE svg [".to_owned() + &"<!ELEMENT a '".repeat(200_000);
    code(many);
}
