# What Doxygen reads instead of the file itself.
#   headers   the fixed form at the top (What, Equation, ...) becomes titled paragraphs, of the file and of the entity that
#             the file is named after; other entities of the file without a comment of their own get its first sentence;
#             a remark after a member's declaration becomes its documentation
#   pages     $...$ and $$...$$ become Doxygen's formulas, links to headers and examples become references

function is_field(s) { return s ~ /^[A-Z][A-Za-z_]*(\([a-z, ]*\))?( [a-zA-Z-]+)?  +[^ ]/ }

function escaped(s) {
    gsub(/\\/, "\\\\", s)
    gsub(/[*@#]/, "\\\\&", s)
    gsub(/&/, "\\&amp;", s)
    gsub(/</, "\\&lt;", s)
    gsub(/>/, "\\&gt;", s)
    return s
}

# The form, as documentation of a file or of an entity. Lines that are set in by four more are code.
function enter(kind) {
    if (mode == kind) return
    if (mode != "") print mode == "code" ? "@endcode" : "@endverbatim"
    if (kind != "") print kind == "code" ? "@code{.cpp}" : "@verbatim"
    mode = kind
}
function print_form(command,   i, s, name, indent) {
    print "/** " command "@brief " escaped(brief)
    indent = 0
    for (i = 1; i <= lines; ++i) {
        s = form[i]
        if (is_field(s)) {
            enter("")
            match(s, /  +/)
            name = substr(s, 1, RSTART - 1)
            indent = RSTART + RLENGTH - 1
            s = substr(s, indent + 1)
            print "\n@par " escaped(name)
            enter(name ~ /^Equation$|[Ll]aws$/ ? "formula" : name == "Example" && s ~ /[;{(]/ ? "code" : "")
        } else {
            match(s, /^ */)
            if (s != "" && RLENGTH < indent) {
                enter("")
                print "\n@par"
                indent = 0
            }
            if (mode != "formula" && name != "Example") {
                if (s != "") enter(RLENGTH >= indent + 4 ? "code" : "")
                if (mode == "code") sub(/^    /, "", s)
            }
            s = substr(s, indent + 1)
        }
        if (mode == "") sub(/^ +/, "", s)
        print mode == "" ? escaped(s) : s
    }
    enter("")
    print "*/"
}

function flush_entity(   words) {
    if (entity == "") return
    words = tolower(entity)
    gsub(/_/, "", words)
    if (!named && words ~ ("[^a-z0-9]" plain_stem "[^a-z0-9]")) {
        print_form("")
        named = 1
    } else {
        print "/// @brief In @ref softtissue" path " \"" substr(path, 2) "\": " escaped(brief)
    }
    printf "%s", entity
    entity = ""
}

# Formulas and references of a page.
function page_line(s,   out, link, text, n, parts, i) {
    out = ""
    n = split(s, parts, "`")  # code stays as it is
    for (i = 1; i <= n; i += 2) {
        while (match(parts[i], /\$\$?[^$]+\$\$?/)) {
            link = substr(parts[i], RSTART, RLENGTH)
            sub(/^\$\$?/, "", link)
            sub(/\$\$?$/, "", link)
            parts[i] = substr(parts[i], 1, RSTART - 1) "\\f" "\001" link "\\f" "\001" substr(parts[i], RSTART + RLENGTH)
        }
        gsub("\001", "$", parts[i])
    }
    for (i = 1; i <= n; ++i) out = out (i > 1 ? "`" : "") parts[i]
    s = out
    out = ""
    while (match(s, /\[[^]\[]*\]\([^) ]*(include\/softtissue\/[a-z0-9_\/]*\.hpp|examples\/[a-z0-9_]*\.cpp)\)/)) {
        link = substr(s, RSTART + 1, RLENGTH - 2)
        out = out substr(s, 1, RSTART - 1)
        s = substr(s, RSTART + RLENGTH)
        i = index(link, "](")
        text = substr(link, 1, i - 1)
        link = substr(link, i + 2)
        if (link ~ /\.hpp$/) {
            sub(/.*include\//, "", link)
            out = out "@ref " link " \"" text "\""
        } else {
            sub(/.*examples\//, "", link)
            gsub(/_/, "__", link)
            sub(/\.cpp$/, "_8cpp-example.html", link)
            out = out "<a href=\"" link "\">" text "</a>"
        }
    }
    return out s
}

FNR == 1 {
    is_page = FILENAME ~ /\.md$/
    path = FILENAME
    sub(/.*\/softtissue\//, "/", path)
    plain_stem = FILENAME
    sub(/.*\//, "", plain_stem)
    sub(/\.hpp$/, "", plain_stem)
    gsub(/_/, "", plain_stem)
    state = "before"
    statement = 1
}

is_page {
    if ($0 ~ /^```/) {
        fenced = !fenced
        print
    } else if (!fenced && $0 ~ /^\$\$ *$/) {
        print (display ? "\\f]" : "\\f[")
        display = !display
    } else if (!fenced && FILENAME ~ /README.md$/ && sub(/^## /, "")) {
        print "<h2>" $0 "</h2>"  # the tree of pages lists the sections of the others only
    } else {
        print (fenced || display ? $0 : page_line($0))
    }
    next
}

state == "before" && /^\/\/\/ @file/ {
    state = "brief"
    next
}
state == "brief" {
    s = $0
    if (sub(/^\/\/\/ ?/, "", s) && s != "") {
        brief = brief (brief == "" ? "" : " ") s
        next
    }
    state = "form"
}
state == "form" {
    s = $0
    if (sub(/^\/\/\/ ?/, "", s)) {
        if (s != "" || lines > 0) form[++lines] = s
        next
    }
    print_form("@file\n")
    print ""
    state = "code"
}

state == "code" {
    if (entity != "") {
        entity = entity $0 "\n"
        if ($0 ~ /[({;=]/ && $0 !~ /^(template|requires)/) flush_entity()
    } else if ($0 ~ /^[a-zA-Z\[]/ && $0 !~ /^(namespace|using namespace|public|private|protected)/ && statement) {
        entity = $0 "\n"
        if ($0 ~ /[({;=]/ && $0 !~ /^(template|requires)/) flush_entity()
    } else {
        if ($0 ~ /^(    )+[a-z].*;  +\/\/ / && in_type) sub(/;  +\/\/ /, ";  ///< ")
        print
    }
    if ($0 ~ /^(class|struct) .*\{$/) in_type = 1
    if ($0 ~ /^\}/) in_type = 0
    statement = $0 ~ /^$/ || $0 ~ /[;{}]( *\/\/.*)?$/
    if ($0 ~ /^\/\/\//) statement = 0
    next
}

{ print }

END { flush_entity() }
