//! The expansion of an invocation whose text is unknown or wrong: it declares the names that the program would have.

use proc_macro2::TokenStream;
use quote::quote;

/// A program with the right names that refuses to run.
pub(crate) fn program() -> TokenStream {
    quote! {
        /// All global variables of the program.
        #[derive(Default)]
        pub struct Globals {}

        impl Globals {
            /// All variables with their start values.
            pub fn new() -> Self {
                Self::default()
            }
        }

        impl ::arl_rt::Program for Globals {
            fn file(&self) -> ::arl_rt::emit::File {
                ::arl_rt::emit::File::new(::core::file!())
            }

            fn family(&self) -> ::arl_rt::emit::Family {
                ::arl_rt::emit::Family::SixAxis
            }

            fn init<'a>(&'a self, _cx: &'a ::arl_rt::Cx) -> ::arl_rt::emit::BoxFuture<'a> {
                ::core::unreachable!("this arl! was expanded without its text")
            }

            fn main<'a>(&'a self, _cx: &'a ::arl_rt::Cx) -> ::arl_rt::emit::BoxFuture<'a> {
                ::core::unreachable!("this arl! was expanded without its text")
            }
        }
    }
}

/// A future of the right type.
pub(crate) fn statements(context: &TokenStream) -> TokenStream {
    quote! {
        {
            let _cx: &::arl_rt::Cx = #context;
            async move {
                if true {
                    ::core::unreachable!("this arl! was expanded without its text")
                }
                ::core::result::Result::Ok::<(), ::arl_rt::emit::Stop>(())
            }
        }
    }
}
