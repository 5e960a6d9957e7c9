// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Lists taxels by their body: first their numbers are counted, in any order, then the places of each body's first taxel
// are added up, a body a cycle, then the taxels pass in raster order.
//
// From a taxel to its place in the list: 1 cycle.

`default_nettype none

module sptfra_regions_list #(
    parameter CONTACTS = 4,
    parameter TAXELS = 100,
    // Derived
    parameter TAXEL_WIDTH = (TAXELS > 8) ? $clog2(TAXELS) : 3
) (
    input  wire clock,
    input  wire reset,
    input  wire clear, // before the first taxel is counted
    input  wire counts, // a taxel
    input  wire [2:0] counted_body,
    input  wire add_up, // one cycle, behind the last one: for as many cycles as there are bodies
    input  wire lists, // a taxel, in raster order
    input  wire [2:0] body,
    output reg  [CONTACTS*(TAXEL_WIDTH+1)-1:0] sizes, // of each body
    // Latency: 1 cycle
    input  wire [TAXEL_WIDTH-1:0] list_address,
    output wire [TAXEL_WIDTH-1:0] list_taxel
);

    generate
        if ((CONTACTS < 2) || (CONTACTS > 8)) begin : gen_check_contacts
            sptfra_error_contacts_must_be_2_to_8 invalid ();
        end
    endgenerate

    localparam SIZE_BITS = TAXEL_WIDTH + 1;
    localparam [31:0] LAST_BODY = CONTACTS - 1;

    // ---- Sizes; while they are added up they go round, one place a cycle
    wire [SIZE_BITS-1:0] first_size = sizes[SIZE_BITS-1:0];
    reg adds;
    reg [2:0] place;
    reg [SIZE_BITS-1:0] passed; // taxels of the bodies before
    genvar index;

    generate
        for (index = 0; index < CONTACTS; index = index + 1) begin : gen_sizes
            localparam NEXT = (index + 1) % CONTACTS;
            localparam [31:0] NUMBER = index;

            always @(posedge clock) begin
                if (adds) begin
                    sizes[SIZE_BITS*index +: SIZE_BITS] <= sizes[SIZE_BITS*NEXT +: SIZE_BITS];
                end else if (counts && (counted_body == NUMBER[2:0])) begin
                    sizes[SIZE_BITS*index +: SIZE_BITS] <= sizes[SIZE_BITS*index +: SIZE_BITS] + 1'b1;
                end
                if (clear) begin
                    sizes[SIZE_BITS*index +: SIZE_BITS] <= {SIZE_BITS{1'b0}};
                end
            end
        end
    endgenerate

    always @(posedge clock) begin
        if (adds) begin
            passed <= passed + first_size;
            place <= place + 1'b1;
            adds <= (place != LAST_BODY[2:0]);
        end
        if (add_up) begin
            adds <= 1'b1;
            place <= 3'd0;
            passed <= {SIZE_BITS{1'b0}};
        end
        if (reset) begin
            adds <= 1'b0;
        end
    end

    // ---- Where each body's next taxel goes
    (* ram_style = "distributed" *) reg [TAXEL_WIDTH-1:0] ends [0:7];
    wire [TAXEL_WIDTH-1:0] end_of_body = ends[body];
    reg [TAXEL_WIDTH-1:0] taxel;

    always @(posedge clock) begin
        if (adds || lists) begin
            ends[adds ? place : body] <= adds ? passed[TAXEL_WIDTH-1:0] : end_of_body + 1'b1;
        end
        if (lists) begin
            taxel <= taxel + 1'b1;
        end
        if (add_up) begin
            taxel <= {TAXEL_WIDTH{1'b0}};
        end
    end

    sptfra_ram #(
        .WIDTH         (TAXEL_WIDTH),
        .DEPTH         (1 << TAXEL_WIDTH),
        .ADDRESS_WIDTH (TAXEL_WIDTH)
    ) list (
        .clock         (clock),
        .write_enable  (lists),
        .write_address (end_of_body),
        .write_data    (taxel),
        .read_enable   (1'b1),
        .read_address  (list_address),
        .read_data     (list_taxel)
    );

endmodule

`default_nettype wire
