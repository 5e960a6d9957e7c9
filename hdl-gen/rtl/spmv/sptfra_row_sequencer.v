// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Row sequencer of a sparse matrix-vector PE: marks the first and the last product of every row.
//
// Reads a ROM with one word a row, {kind[1:0], macs[13:0]} with macs >= 1 products. The ROM is outside and
// registered: row_word is the word at the row_address of the last cycle with row_fetch. One product a cycle, rows
// of one product back to back included; first, last and kind belong to the same cycle as issue.

`default_nettype none

module sptfra_row_sequencer (
    input  wire clock,                 // rising edge
    input  wire restart,               // at first, and at any time: issue may follow two cycles later
    input  wire [15:0] start_address,  // with restart: address of the word to go on from
    input  wire issue,                 // one product is issued in this cycle
    input  wire [15:0] row_word,       // the ROM's answer: {kind[1:0], macs[13:0]}
    output wire [15:0] row_address,    // the ROM's address
    output wire row_fetch,             // the ROM reads
    output wire first,                 // with issue: first product of its row
    output wire last,                  // with issue: last product of its row
    output wire [1:0] kind             // with issue: the row's kind
);

    reg [15:0] pointer;
    reg primes;
    reg at_start;
    reg [13:0] remaining;
    reg [1:0] row_kind;

    reg [13:0] count;
    reg [1:0] current_kind;

    // products of this row from this one on
    always @(*) begin
        if (at_start) begin
            count = row_word[13:0];
            current_kind = row_word[15:14];
        end else begin
            count = remaining;
            current_kind = row_kind;
        end
    end

    wire at_end = count == 14'd1;

    // the next row's word is fetched as soon as this row starts
    wire fetch = primes || (issue && at_start);

    always @(posedge clock) begin
        if (fetch) begin
            pointer <= pointer + 16'd1;
        end
        if (issue) begin
            at_start <= at_end;
            remaining <= count - 14'd1;
            row_kind <= current_kind;
        end

        // on to another row
        primes <= restart;
        if (restart) begin
            pointer <= start_address;
            at_start <= 1'b1;
        end
    end

    assign row_address = pointer;
    assign row_fetch = fetch;
    assign first = at_start;
    assign last = at_end;
    assign kind = current_kind;

endmodule

`default_nettype wire
